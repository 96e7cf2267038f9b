package rotra.jason;

import jason.architecture.AgArch;
import jason.asSemantics.ActionExec;
import jason.asSyntax.Literal;
import jason.runtime.RuntimeServicesFactory;
import java.io.IOException;
import java.io.Reader;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.Collection;
import java.util.logging.Level;
import javax.json.Json;
import javax.json.JsonObject;
import javax.json.JsonReader;

/**
 * The same ride under Jason's own runner: this architecture is named in a .mas2j project and needs nothing else of ours.
 *
 * <p>In: the agent options {@code job} (a file as {@link Job} reads it) and {@code trace} (the file to write).  Out: the trace, equal
 * to that of {@link Lockstep}.  A step ends with the reasoning cycle after which the mind is at rest.
 */
public final class StockDriverArch extends AgArch {

    private static final long serialVersionUID = 1L;

    private transient Ride ride;
    private transient Collection<Literal> percepts;
    private int cap;
    private int cycles;
    private boolean mayRest;
    private boolean over;

    @Override
    public void init() throws Exception {
        String file = DriverAgent.option(getTS().getAg(), "job");
        Job job;
        try (Reader text = Files.newBufferedReader(Path.of(file), StandardCharsets.UTF_8); JsonReader json = Json.createReader(text)) {
            job = Job.read(json.readObject());
        }
        cap = job.cap();
        ride = new Ride(job, getTS());
        percepts = ride.next();
    }

    @Override
    public Collection<Literal> perceive() {
        Ride.forgetSelection(getTS().getC());
        Collection<Literal> fresh = percepts;
        percepts = null;
        return fresh;
    }

    @Override
    public void act(ActionExec act) {
        ride.acted(act);
    }

    @Override
    public void reasoningCycleFinished() {
        if (over) {
            return;
        }
        ride.cycled();
        cycles++;
        mayRest = true;
        boolean rests = getTS().canSleep();
        mayRest = false;
        if (!rests && cycles < cap) {
            return;
        }
        if (!rests) {
            ride.restless(cycles);
        }
        ride.rested();
        cycles = 0;
        percepts = ride.next();
        if (percepts == null) {
            over = true;
            finish();
        }
    }

    /** While a step is under way no part of a cycle is left out, so that its cycles are those of any other runner. */
    @Override
    public boolean canSleep() {
        return mayRest || over;
    }

    private void finish() {
        try {
            JsonObject trace = ride.answer().build();
            Files.writeString(Path.of(DriverAgent.option(getTS().getAg(), "trace")), trace.toString() + "\n", StandardCharsets.UTF_8);
        } catch (IOException e) {
            getTS().getLogger().log(Level.SEVERE, "the trace cannot be written", e);
        }
        // from a thread of its own: it waits for this one
        new Thread(this::stopAll, "the run is over").start();
    }

    private void stopAll() {
        try {
            RuntimeServicesFactory.get().stopMAS(0, true, 0);
        } catch (Exception e) {
            getTS().getLogger().log(Level.SEVERE, "Jason does not stop", e);
        }
    }
}

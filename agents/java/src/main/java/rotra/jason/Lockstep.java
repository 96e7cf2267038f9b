package rotra.jason;

import jason.architecture.AgArch;
import jason.asSemantics.ActionExec;
import jason.asSemantics.Agent;
import jason.asSemantics.Message;
import jason.asSemantics.TransitionSystem;
import jason.asSyntax.Literal;
import jason.runtime.Settings;
import jason.mas2j.ClassParameters;
import java.util.Collection;
import javax.json.JsonObject;

/**
 * Runs a driver without threads: percepts in, reasoning cycles to rest, one act out, and the next step.
 *
 * <p>In: a job.  Out: its trace.  The same job gives the same trace.
 */
final class Lockstep extends AgArch {

    private static final long serialVersionUID = 1L;

    private final transient Ride ride;
    private final int cap;
    private transient Collection<Literal> percepts;

    Lockstep(Job job) throws Exception {
        Settings settings = new Settings();
        settings.addOption(DriverAgent.RULES, job.rules());
        Agent.create(this, DriverAgent.class.getName(), new ClassParameters(IndexedBeliefBase.class.getName()), job.agent(), settings);
        cap = job.cap();
        ride = new Ride(job, getTS());
    }

    /** The whole run. */
    JsonObject run() {
        long start = System.nanoTime();
        percepts = ride.next();
        while (percepts != null) {
            deliberate();
            ride.rested();
            percepts = ride.next();
        }
        double seconds = (System.nanoTime() - start) / 1e9;
        return ride.answer().add("steps_per_second", Math.round(ride.steps() / Math.max(seconds, 1e-9))).build();
    }

    private void deliberate() {
        TransitionSystem mind = getTS();
        int cycles = 0;
        do {
            mind.reasoningCycle();
            ride.cycled();
            cycles++;
        } while (!mind.canSleep() && cycles < cap);
        if (!mind.canSleep()) {
            ride.restless(cycles);
        }
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
    public String getAgName() {
        return "driver";
    }

    @Override
    public boolean isRunning() {
        return true;
    }

    @Override
    public boolean canSleep() {
        return true;
    }

    @Override
    public void wake() { }

    @Override
    public void wakeUpSense() { }

    @Override
    public void wakeUpDeliberate() { }

    @Override
    public void wakeUpAct() { }

    @Override
    public void checkMail() { }

    @Override
    public void sendMsg(Message message) {
        throw new UnsupportedOperationException("a driver sends no messages");
    }

    @Override
    public void broadcast(Message message) {
        throw new UnsupportedOperationException("a driver sends no messages");
    }
}

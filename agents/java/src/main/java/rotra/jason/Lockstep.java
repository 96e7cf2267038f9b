package rotra.jason;

import jason.asSemantics.ActionExec;
import jason.asSemantics.Agent;
import jason.asSyntax.Literal;
import jason.mas2j.ClassParameters;
import jason.runtime.Settings;
import java.util.Collection;
import javax.json.JsonObject;

/**
 * Runs a driver without threads: percepts in, reasoning cycles to rest, one act out, and the next step.
 *
 * <p>In: a job.  Out: its trace.  The same job gives the same trace.
 */
final class Lockstep extends Unthreaded {

    private static final long serialVersionUID = 1L;

    private final transient Ride ride;
    private final int cap;

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
        Collection<Literal> percepts = ride.next();
        while (percepts != null) {
            int cycles = deliberate(percepts, cap);
            if (cycles < 0) {
                ride.restless(-cycles);
            }
            ride.rested();
            percepts = ride.next();
        }
        double seconds = (System.nanoTime() - start) / 1e9;
        return ride.answer().add("steps_per_second", Math.round(ride.steps() / Math.max(seconds, 1e-9))).build();
    }

    @Override
    void cycled() {
        ride.cycled();
    }

    @Override
    public void act(ActionExec act) {
        ride.acted(act);
    }
}

package rotra.jason;

import jason.architecture.AgArch;
import jason.asSemantics.Message;
import jason.asSemantics.TransitionSystem;
import jason.asSyntax.Literal;
import java.util.Collection;

/**
 * An agent architecture without threads, clocks and messages: whoever owns it calls the reasoning cycles.
 *
 * <p>In: the percepts of a step.  Out: a mind at rest, or still busy after as many cycles as allowed.  Left to subclasses: acts.
 */
abstract class Unthreaded extends AgArch {

    private static final long serialVersionUID = 1L;

    private transient Collection<Literal> percepts;

    /** Reasoning cycles until the mind rests; their number, negative where it does not rest within `cap` cycles. */
    final int deliberate(Collection<Literal> seen, int cap) {
        TransitionSystem mind = getTS();
        percepts = seen;
        int cycles = 0;
        do {
            mind.reasoningCycle();
            cycled();
            cycles++;
        } while (!mind.canSleep() && cycles < cap);
        return mind.canSleep() ? cycles : -cycles;
    }

    /** A cycle has ended. */
    abstract void cycled();

    @Override
    public final Collection<Literal> perceive() {
        Ride.forgetSelection(getTS().getC());
        Collection<Literal> fresh = percepts;
        percepts = null;
        return fresh;
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

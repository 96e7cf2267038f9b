package rotra.jason;

import jason.asSemantics.ActionExec;
import jason.asSemantics.Circumstance;
import jason.asSemantics.Option;
import jason.asSemantics.TransitionSystem;
import jason.asSyntax.Atom;
import jason.asSyntax.Literal;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.Collection;
import java.util.HashMap;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;
import javax.json.JsonArrayBuilder;
import javax.json.Json;
import javax.json.JsonObject;
import javax.json.JsonObjectBuilder;
import javax.json.JsonValue;
import rotra.world.Act;
import rotra.world.Percept;
import rotra.world.World;

/**
 * One driver in its world, step by step, whoever runs its reasoning cycles: {@link Lockstep} or stock Jason ({@link StockDriverArch}).
 *
 * <pre>
 *     next() -> percepts; cycles until at rest, with acted(..) for each act asked for and cycled() after each cycle; rested()
 * </pre>
 *
 * In: a job; the mind (a TransitionSystem) at rest.  Out: percepts, the results of acts as Jason's feedback, a trace (design,
 * section 4).  The first act asked for in a step is the act; later ones fail with reason `busy`.
 */
final class Ride {

    static final String BUSY = "busy";
    /** A mind that does not rest would fill the trace. */
    static final int PLANS_SHOWN = 100;

    private final Job job;
    private final World world;
    private final String driver;
    private final TransitionSystem mind;
    private final RestReader reader;
    private final Map<Percept, Literal> literals = new HashMap<>();
    private final List<ActionExec> asked = new ArrayList<>();
    private final List<Option> chosen = new ArrayList<>();
    private final JsonArrayBuilder steps = Json.createArrayBuilder();
    private List<Percept> seen = List.of();
    private int step;
    private JsonObject fault;

    Ride(Job job, TransitionSystem mind) {
        this.job = job;
        this.mind = mind;
        world = World.start(job.world(), job.start());
        driver = job.world().driver().name();
        reader = job.trace() ? new RestReader(mind, Act.all(job.world().topSpeed())) : null;
    }

    /** Is the run over with the step that was begun last? */
    private boolean over() {
        boolean reached = job.until().equals("crashed") && !job.world().isOpen() && world.crashed(driver) || job.until().equals("finished") && world.finished();
        return fault != null || step >= job.steps() || reached;
    }

    /** The percepts of the next step in which the driver thinks, a fresh sorted list; null when the run is over. */
    Collection<Literal> next() {
        while (!over()) {
            Collection<Literal> percepts = sense();
            if (thinks()) {
                return percepts;
            }
            mind.getAg().buf(percepts);
            rested();
        }
        return null;
    }

    /** A new step: the rules may be other ones from now on, the world chooses, the driver senses. */
    private Collection<Literal> sense() {
        step++;
        if (job.then().containsKey(step)) {
            ((DriverAgent) mind.getAg()).obey(Path.of(job.then().get(step).file()));
        }
        choose();
        seen = world.perceive(driver);
        List<Literal> percepts = new ArrayList<>(seen.size());
        seen.forEach(p -> percepts.add(literals.computeIfAbsent(p, Words::literal)));
        return percepts;
    }

    private void choose() {
        boolean told = job.choices() != null || job.percepts() != null;
        if (!told && job.chance() != null) {
            world.choose(job.chance());
        }
        if (job.choices() != null && step <= job.choices().size()) {
            world.setHesitating(new LinkedHashSet<>(job.choices().get(step - 1)));
        }
        if (job.percepts() != null && step <= job.percepts().size()) {
            world.setPercepts(job.percepts().get(step - 1));
        }
    }

    int steps() {
        return step;
    }

    /** May the driver think in this step?  A crashed one does nothing more. */
    private boolean thinks() {
        return job.world().isOpen() || !world.crashed(driver);
    }

    /** An act was asked for. */
    void acted(ActionExec act) {
        asked.add(act);
    }

    /** A cycle has ended: which plan was chosen in it? */
    void cycled() {
        Option option = mind.getC().getSelectedOption();
        if (option != null && job.trace()) {
            chosen.add(option);
        }
    }

    /** The mind is at rest: everything is read, all act, the results of the acts wait as feedback for the next step. */
    void rested() {
        forgetSelection(mind.getC());
        Act act = asked.isEmpty() ? Act.WAIT : Words.act(asked.get(0).getActionTerm());
        if (job.trace()) {
            steps.add(record(act));
        }
        boolean thinks = thinks();
        boolean done = world.step(Map.of(driver, act)).get(driver);
        // a driver that has crashed is told nothing any more
        if (thinks && thinks()) {
            for (int i = 0; i < asked.size(); i++) {
                answer(asked.get(i), i == 0 && done, i == 0 ? World.NO_SUCH_ACT : BUSY);
            }
        }
        asked.clear();
        chosen.clear();
    }

    private void answer(ActionExec act, boolean done, String reason) {
        act.setResult(done);
        if (!done) {
            act.setFailureReason(new Atom(reason), reason);
        }
        mind.getAgArch().getFirstAgArch().actionExecuted(act);
    }

    /** The mind did not come to rest within so many cycles. */
    void restless(int cycles) {
        fault = Json.createObjectBuilder().add("kind", "restless").add("step", step)
                .add("message", "no rest after " + cycles + " reasoning cycles in step " + step).build();
    }

    /**
     * Jason keeps the intention that was last selected until another one is, though it may be gone; `.intend` would still
     * find it.  A driver's intentions are those it has.
     */
    static void forgetSelection(Circumstance circumstance) {
        circumstance.resetDeliberate();
        circumstance.resetAct();
    }

    // -- the trace ------------------------------------------------------------------------------------------------------

    private JsonObject record(Act act) {
        JsonObjectBuilder out = state();
        JsonArrayBuilder percepts = Json.createArrayBuilder();
        seen.forEach(p -> percepts.add(p.toString()));
        out.add("percepts", percepts).add("hesitates", Json.createArrayBuilder(world.hesitating()));
        boolean legal = Act.all(job.world().topSpeed()).contains(act);
        JsonArrayBuilder busy = Json.createArrayBuilder();
        asked.stream().skip(1).forEach(a -> busy.add(Words.act(a.getActionTerm()).toString()));
        out.add("acts", Json.createObjectBuilder().add(driver, legal && thinks() ? act.toString() : Act.WAIT.toString())).add("busy", busy);
        out.add("plans", plans());
        reader.read(legal ? act : Act.WAIT, thinks(), out);
        if (fault != null) {
            out.add("restless", true);
        }
        if (job.then().containsKey(step)) {
            out.add("rules", job.then().get(step).name());
        }
        if (step == 1) {
            out.add("start", job.startJson());
        }
        return out.build();
    }

    private JsonObjectBuilder state() {
        JsonObjectBuilder out = Json.createObjectBuilder().add("step", step);
        world.snapshot().toJson().forEach(out::add);
        return out;
    }

    private JsonArrayBuilder plans() {
        JsonArrayBuilder out = Json.createArrayBuilder();
        chosen.stream().limit(PLANS_SHOWN).forEach(option -> out.add(PlanName.of(option.getPlan())));
        return out;
    }

    /** {"steps", "fault"}; the last record has the state alone. */
    JsonObjectBuilder answer() {
        if (job.trace() && fault == null) {
            step++;
            steps.add(state());
        }
        return Json.createObjectBuilder().add("steps", steps).add("fault", fault == null ? JsonValue.NULL : fault);
    }
}

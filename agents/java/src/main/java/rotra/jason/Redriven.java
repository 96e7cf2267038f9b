package rotra.jason;

import jason.asSemantics.ActionExec;
import jason.asSemantics.Agent;
import jason.asSemantics.Circumstance;
import jason.asSemantics.Event;
import jason.asSemantics.Intention;
import jason.asSemantics.Option;
import jason.asSemantics.TransitionSystem;
import jason.asSyntax.Atom;
import jason.asSyntax.Literal;
import jason.asSyntax.PredicateIndicator;
import jason.asSyntax.Rule;
import jason.asSyntax.Trigger;
import jason.asSyntax.Trigger.TEOperator;
import jason.asSyntax.Trigger.TEType;
import jason.bb.BeliefBase;
import jason.mas2j.ClassParameters;
import jason.runtime.Settings;
import java.util.ArrayList;
import java.util.Collection;
import java.util.Iterator;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Set;
import java.util.SortedSet;
import java.util.TreeSet;
import javax.json.Json;
import javax.json.JsonArrayBuilder;
import javax.json.JsonObjectBuilder;
import rotra.world.Act;
import rotra.world.Percept;
import rotra.world.Scenario;
import rotra.world.World;

/**
 * One real Jason agent that can be set back to its start and driven again, step by step, through the percepts of a history.
 *
 * <p>In: percepts; whether the driver survived the step.  Out: what is at rest, as a trace has it, and the mind's key.
 * Left to others: which histories (Explorer), what the world makes of an act.
 */
final class Redriven extends Unthreaded {

    private static final long serialVersionUID = 1L;

    private final transient Settings settings = new Settings();
    private final transient List<Act> acts;
    private final int cap;
    private final transient MindKey key;
    private final transient List<Literal> beliefsAtFirst = new ArrayList<>();
    private final transient List<Trigger> eventsAtFirst = new ArrayList<>();
    private final transient List<ActionExec> asked = new ArrayList<>();
    private final transient List<Option> chosen = new ArrayList<>();
    private boolean restless;

    Redriven(String agent, String rules, Scenario world, int cap) throws Exception {
        settings.addOption(DriverAgent.RULES, rules);
        Agent.create(this, DriverAgent.class.getName(), new ClassParameters(IndexedBeliefBase.class.getName()), agent, settings);
        this.cap = cap;
        acts = Act.all(world.topSpeed());
        key = new MindKey(getTS());
        Set<PredicateIndicator> changing = changing();
        for (Literal belief : beliefs()) {
            if (changing.contains(belief.getPredicateIndicator())) {
                beliefsAtFirst.add(belief.copy());
            }
        }
        getTS().getC().getEventsPlusAtomic().forEachRemaining(event -> eventsAtFirst.add(event.getTrigger().clone()));
    }

    private BeliefBase beliefs() {
        return getTS().getAg().getBB();
    }

    /** The names of all that can be added or taken away: facts, not rules. */
    private Set<PredicateIndicator> changing() {
        Set<PredicateIndicator> names = new LinkedHashSet<>();
        for (Literal belief : beliefs()) {
            if (!(belief instanceof Rule rule) || rule.getBody() == Literal.LTrue) {
                names.add(belief.getPredicateIndicator());
            }
        }
        return names;
    }

    /** As it was before its first step. */
    void restart() {
        Agent agent = getTS().getAg();
        changing().forEach(name -> agent.getBB().abolish(Literal.DefaultNS, name));
        for (Literal belief : beliefsAtFirst) {
            agent.getBB().add(1, belief.copy());
        }
        TransitionSystem mind = new TransitionSystem(agent, new Circumstance(), settings, this);
        eventsAtFirst.forEach(trigger -> mind.getC().addEvent(new Event(trigger.clone(), Intention.EmptyInt)));
        asked.clear();
        chosen.clear();
        restless = false;
    }

    /** One step up to rest. */
    void sense(Collection<Percept> percepts) {
        asked.clear();
        chosen.clear();
        restless = deliberate(percepts.stream().map(Words::literal).toList(), cap) < 0;
        Ride.forgetSelection(getTS().getC());
    }

    /** Nothing is perceived, and nothing thought, by a driver that has crashed. */
    void crash() {
        asked.clear();
        chosen.clear();
        getTS().getAg().buf(List.of());
    }

    /** The results of the acts wait for the next step (model/README.md: the first act asked for is the one that is done). */
    void survive() {
        for (int i = 0; i < asked.size(); i++) {
            ActionExec act = asked.get(i);
            boolean done = i == 0 && acts.contains(act(i));
            act.setResult(done);
            if (!done) {
                String reason = i == 0 ? World.NO_SUCH_ACT : Ride.BUSY;
                act.setFailureReason(new Atom(reason), reason);
            }
            actionExecuted(act);
        }
    }

    boolean restless() {
        return restless;
    }

    /** The first act asked for, as the world is told it. */
    Act act() {
        return asked.isEmpty() ? Act.WAIT : act(0);
    }

    private Act act(int i) {
        return Words.act(asked.get(i).getActionTerm());
    }

    String key() {
        return key.of(getTS(), asked, watched());
    }

    /** The percepts of the last step that some plan waits for to come or go: all that is left of a step when the next begins. */
    SortedSet<String> watched() {
        SortedSet<String> found = new TreeSet<>();
        Iterator<Literal> known = beliefs().getPercepts();
        while (known.hasNext()) {
            Literal percept = known.next();
            boolean waited = false;
            for (TEOperator operator : List.of(TEOperator.add, TEOperator.del)) {
                waited |= getTS().getAg().getPL().hasCandidatePlan(new Trigger(operator, TEType.belief, percept));
            }
            if (waited) {
                found.add(Words.show(percept));
            }
        }
        return found;
    }

    /** The driver's own beliefs that can change. */
    SortedSet<String> own() {
        SortedSet<String> found = new TreeSet<>();
        for (Literal belief : beliefs()) {
            if (!belief.isRule() && belief.hasSource(BeliefBase.ASelf)) {
                found.add(Words.show(belief));
            }
        }
        return found;
    }

    /** What a trace shows of a step at rest; `alive`: a driver that has crashed ignores nothing. */
    void read(boolean alive, JsonObjectBuilder out) {
        Act first = act();
        Act done = acts.contains(first) ? first : Act.WAIT;
        JsonArrayBuilder busy = Json.createArrayBuilder();
        for (int i = 1; i < asked.size(); i++) {
            busy.add(act(i).toString());
        }
        JsonArrayBuilder plans = Json.createArrayBuilder();
        chosen.stream().limit(Ride.PLANS_SHOWN).forEach(option -> plans.add(PlanName.of(option.getPlan())));
        out.add("act", done.toString()).add("busy", busy).add("plans", plans).add("restless", restless);
        new RestReader(getTS(), acts).read(done, alive, out);
    }

    @Override
    void cycled() {
        Option option = getTS().getC().getSelectedOption();
        if (option != null) {
            chosen.add(option);
        }
    }

    @Override
    public void act(ActionExec act) {
        asked.add(act);
    }
}

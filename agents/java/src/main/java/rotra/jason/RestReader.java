package rotra.jason;

import jason.asSemantics.Agent;
import jason.asSemantics.Circumstance;
import jason.asSemantics.IntendedMeans;
import jason.asSemantics.Intention;
import jason.asSemantics.TransitionSystem;
import jason.asSemantics.Unifier;
import jason.asSyntax.ASSyntax;
import jason.asSyntax.Literal;
import jason.asSyntax.Rule;
import jason.asSyntax.StringTerm;
import jason.asSyntax.Term;
import jason.asSyntax.Trigger;
import jason.asSyntax.Trigger.TEOperator;
import jason.asSyntax.Trigger.TEType;
import jason.asSyntax.VarTerm;
import jason.bb.BeliefBase;
import java.util.ArrayList;
import java.util.Iterator;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.SortedSet;
import java.util.TreeSet;
import javax.json.Json;
import javax.json.JsonArrayBuilder;
import javax.json.JsonObjectBuilder;
import rotra.world.Act;

/**
 * What a mind at rest holds, asked of the mind itself: its situation, the advice, what the act goes against, beliefs, goals.
 *
 * <p>In: a mind, the act it asked for.  Out: the entries of a trace step (design, section 4).  Left to others: the world's part.
 */
final class RestReader {

    private record Directive(String label, String action) { }

    private static final String MUST = "must";
    private static final Set<String> ADVISER = Set.of("advised", "advised_next", "rule_of", "contradicted", "intends");

    private final TransitionSystem mind;
    private final Agent agent;
    private final List<Act> acts;
    private final Literal rules = ASSyntax.createLiteral("rule_of", new VarTerm("Rule"), new VarTerm("Label"), new VarTerm("Action"));

    RestReader(TransitionSystem mind, List<Act> acts) {
        this.mind = mind;
        this.agent = mind.getAg();
        this.acts = acts;
    }

    /** Adds situation, advice, ignored, justified, beliefs and goals; a driver that has crashed ignores nothing. */
    void read(Act act, boolean thinks, JsonObjectBuilder out) {
        SortedSet<String> contexts = values("context");
        JsonObjectBuilder situation = Json.createObjectBuilder();
        if (contexts.isEmpty()) {
            situation.addNull("context");
        } else {
            situation.add("context", contexts.first());
        }
        situation.add("beliefs", Json.createArrayBuilder(values("believes"))).add("intentions", Json.createArrayBuilder(values("intends")));
        Map<Directive, SortedSet<String>> advice = advice();
        JsonArrayBuilder advised = Json.createArrayBuilder();
        JsonArrayBuilder ignored = Json.createArrayBuilder();
        JsonArrayBuilder justified = Json.createArrayBuilder();
        advice.forEach((directive, names) -> {
            advised.add(named(directive).add("rules", Json.createArrayBuilder(names)));
            if (thinks && contradicts(directive, act)) {
                (excused(directive, advice) ? justified : ignored).add(named(directive));
            }
        });
        out.add("situation", situation).add("advice", advised).add("ignored", ignored).add("justified", justified);
        out.add("beliefs", Json.createArrayBuilder(beliefs())).add("goals", Json.createArrayBuilder(goals()));
    }

    private static JsonObjectBuilder named(Directive directive) {
        return Json.createObjectBuilder().add("label", directive.label).add("action", directive.action);
    }

    /** Must before all else, then by label and action. */
    private Map<Directive, SortedSet<String>> advice() {
        List<Directive> order = new ArrayList<>();
        Map<Directive, SortedSet<String>> found = new LinkedHashMap<>();
        Iterator<Unifier> solutions = rules.logicalConsequence(agent, new Unifier());
        while (solutions.hasNext()) {
            Unifier u = solutions.next();
            Directive directive = new Directive(text(u.get("Label")), text(u.get("Action")));
            found.computeIfAbsent(directive, d -> {
                order.add(d);
                return new TreeSet<>();
            }).add(text(u.get("Rule")));
        }
        order.sort((a, b) -> a.label.equals(b.label) ? a.action.compareTo(b.action)
                : a.label.equals(MUST) ? -1 : b.label.equals(MUST) ? 1 : a.label.compareTo(b.label));
        Map<Directive, SortedSet<String>> sorted = new LinkedHashMap<>();
        order.forEach(d -> sorted.put(d, found.get(d)));
        return sorted;
    }

    private boolean contradicts(Directive directive, Act act) {
        Term action = directive.action.matches("[a-z][A-Za-z0-9_]*") ? ASSyntax.createAtom(directive.action) : ASSyntax.createString(directive.action);
        Literal asked = ASSyntax.createLiteral("contradicted", action, Words.term(act));
        return asked.logicalConsequence(agent, new Unifier()).hasNext();
    }

    /** A directive that is not a must, and that no act can heed without going against a must in force (design, section 7). */
    private boolean excused(Directive directive, Map<Directive, SortedSet<String>> advice) {
        if (directive.label.equals(MUST)) {
            return false;
        }
        List<Directive> musts = advice.keySet().stream().filter(d -> d.label.equals(MUST)).toList();
        return acts.stream().allMatch(a -> contradicts(directive, a) || musts.stream().anyMatch(m -> contradicts(m, a)));
    }

    private SortedSet<String> values(String functor) {
        SortedSet<String> found = new TreeSet<>();
        Iterator<Unifier> solutions = ASSyntax.createLiteral(functor, new VarTerm("Any")).logicalConsequence(agent, new Unifier());
        while (solutions.hasNext()) {
            found.add(text(solutions.next().get("Any")));
        }
        return found;
    }

    /** The agent's own beliefs; a rule whose body is `true` is one, but those of the rule base are not. */
    private SortedSet<String> beliefs() {
        SortedSet<String> found = new TreeSet<>();
        for (Literal belief : agent.getBB()) {
            if (belief instanceof Rule rule) {
                if (rule.getBody() == Literal.LTrue && !ADVISER.contains(rule.getFunctor())) {
                    found.add(Words.show(rule.headClone()));
                }
            } else if (belief.hasSource(BeliefBase.ASelf)) {
                found.add(Words.show(belief));
            }
        }
        return found;
    }

    private SortedSet<String> goals() {
        SortedSet<String> found = new TreeSet<>();
        Circumstance c = mind.getC();
        Iterator<Intention> all = c.getAllIntentions();
        while (all.hasNext()) {
            for (IntendedMeans means : all.next()) {
                Trigger trigger = means.getTrigger();
                if (trigger.getOperator() == TEOperator.add && trigger.getType() == TEType.achieve) {
                    found.add(Words.show((Literal) trigger.getLiteral().capply(means.getUnif())));
                }
            }
        }
        return found;
    }

    private static String text(Term term) {
        return term instanceof StringTerm string ? string.getString() : term.toString();
    }
}

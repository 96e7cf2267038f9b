package rotra.jason;

import jason.asSemantics.ActionExec;
import jason.asSemantics.Circumstance;
import jason.asSemantics.Event;
import jason.asSemantics.IntendedMeans;
import jason.asSemantics.Intention;
import jason.asSemantics.TransitionSystem;
import jason.asSemantics.Unifier;
import jason.asSyntax.Literal;
import jason.asSyntax.Plan;
import jason.asSyntax.PlanBody;
import jason.asSyntax.Term;
import jason.asSyntax.VarTerm;
import java.lang.reflect.Field;
import java.util.Collection;
import java.util.HashMap;
import java.util.IdentityHashMap;
import java.util.Iterator;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;
import java.util.regex.Matcher;
import java.util.regex.Pattern;

/**
 * The text of all that a mind at rest carries into its next step: two minds with one text have one future.
 *
 * <p>In: a mind between two steps, the acts it waits for, the percepts whose coming or going it watches.  Out: a text.
 * Intention numbers, names of variables and the like are left out or numbered anew: they are never asked for.
 */
final class MindKey {

    private static final Pattern NAMELESS = Pattern.compile("\\b_[0-9][A-Za-z0-9_]*|\\b_[A-Z][A-Za-z0-9_]*");
    private static final Field RESULTS = results();

    private final Map<Plan, Integer> numbers = new IdentityHashMap<>();

    MindKey(TransitionSystem mind) {
        int number = 0;
        for (Plan plan : mind.getAg().getPL()) {
            numbers.put(plan, number++);
        }
    }

    /** Jason keeps to itself which result of a goal a variable of the plan below waits for. */
    private static Field results() {
        try {
            Field field = IntendedMeans.class.getDeclaredField("renamedVars");
            field.setAccessible(true);
            return field;
        } catch (NoSuchFieldException e) {
            throw new IllegalStateException(e);
        }
    }

    String of(TransitionSystem mind, List<ActionExec> asked, Collection<String> watched) {
        Circumstance c = mind.getC();
        if (c.hasPendingEvent() || !c.getPendingIntentions().isEmpty() || c.getPendingActions().size() != asked.size()) {
            throw new IllegalStateException("a mind that waits for more than the results of its acts has no canonical form");
        }
        StringBuilder out = new StringBuilder("watched ").append(watched).append("\nbeliefs ");
        Map<String, StringBuilder> beliefs = new TreeMap<>();
        for (Literal belief : mind.getAg().getBB()) {
            if (!belief.isRule() && belief.hasSource(jason.bb.BeliefBase.ASelf)) {
                // the order in which beliefs of one name are found is part of the mind
                beliefs.computeIfAbsent(belief.getPredicateIndicator().toString(), k -> new StringBuilder()).append(belief).append(' ');
            }
        }
        beliefs.values().forEach(out::append);
        Iterator<Event> events = c.getEventsPlusAtomic();
        while (events.hasNext()) {
            Event event = events.next();
            out.append("\nevent ").append(event.getTrigger());
            intention(event.getIntention(), out);
        }
        Iterator<Intention> running = c.getRunningIntentionsPlusAtomic();
        while (running.hasNext()) {
            out.append("\nruns");
            intention(running.next(), out);
        }
        boolean answered = !c.getFeedbackActions().isEmpty();
        for (ActionExec act : answered ? c.getFeedbackActions() : asked) {
            out.append("\nasked ");
            if (!answered) {
                out.append(act.getActionTerm());
            } else if (act.getResult()) {
                out.append("done");
            } else {
                out.append("failed ").append(act.getActionTerm()).append(' ').append(act.getFailureReason());
            }
            intention(act.getIntention(), out);
        }
        return renumbered(out.append(c.isAtomicIntentionSuspended() ? "\nfrozen" : "").toString());
    }

    private void intention(Intention intention, StringBuilder out) {
        if (intention == null) {
            return;
        }
        out.append(intention.isSuspended() ? " suspended" : "").append(intention.isAtomic() ? " atomic" : "");
        for (IntendedMeans means : intention) {
            out.append("\n    ").append(means.getTrigger().getOperator()).append(means.getTrigger().getType())
                    .append(means.getTrigger().getLiteral().capply(means.getUnif())).append(" plan ").append(numbers.getOrDefault(means.getPlan(), -1)).append(": ");
            PlanBody rest = means.isFinished() ? null : means.getCurrentStep();
            if (rest != null) {
                out.append(((PlanBody) rest.clone()).capply(means.getUnif()));
                waiting(means, (Term) rest, out);
            }
        }
    }

    /** Which variable of the body gets its value from the goal above. */
    private static void waiting(IntendedMeans means, Term rest, StringBuilder out) {
        Unifier links;
        try {
            links = (Unifier) RESULTS.get(means);
        } catch (IllegalAccessException e) {
            throw new IllegalStateException(e);
        }
        if (links == null) {
            return;
        }
        Map<VarTerm, Integer> used = new HashMap<>();
        rest.countVars(used);
        Map<String, String> waits = new TreeMap<>();
        for (VarTerm own : used.keySet()) {
            Term link = links.get(own);
            if (link != null && means.getUnif().get(own) == null) {
                waits.put(own.toString(), link.toString());
            }
        }
        out.append(waits.isEmpty() ? "" : " waits " + waits);
    }

    private static String renumbered(String text) {
        Map<String, String> names = new HashMap<>();
        Matcher nameless = NAMELESS.matcher(text);
        return nameless.replaceAll(m -> names.computeIfAbsent(m.group(), n -> "_" + names.size()));
    }
}

package rotra.jason;

import jason.RevisionFailedException;
import jason.asSemantics.Agent;
import jason.asSemantics.Event;
import jason.asSemantics.Intention;
import jason.asSyntax.Literal;
import jason.asSyntax.PredicateIndicator;
import jason.asSyntax.Trigger;
import jason.asSyntax.Trigger.TEOperator;
import jason.asSyntax.Trigger.TEType;
import jason.bb.BeliefBase;
import jason.bb.StructureWrapperForLiteral;
import java.io.Reader;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.Collection;
import java.util.HashSet;
import java.util.Iterator;
import java.util.List;
import java.util.Set;
import java.util.TreeSet;

/**
 * A Jason agent whose percepts come and go in one fixed order, and that knows the rule base.
 *
 * <p>In: the percepts of a step, sorted.  Out: events of those that went, then of those that came, each in that order; queries
 * find percepts in that order too.  Jason's own order depends on hashes and on history (model/README.md, Percepts).
 * The rule base is the file named by the agent option {@code rules}; Jason's plans for messages are not loaded.
 */
public final class DriverAgent extends Agent {

    private static final long serialVersionUID = 1L;
    static final String RULES = "rules";
    private static final String FILE = "file:";
    /** What a rule base adds to an agent. */
    private static final List<PredicateIndicator> ADVICE = List.of(new PredicateIndicator("advised", 2), new PredicateIndicator("advised_next", 2),
            new PredicateIndicator("rule_of", 3), new PredicateIndicator("contradicted", 2), new PredicateIndicator("intends", 1));

    /** As Jason does, but the file is named in full, so that includes are found beside it and plans say where they stand. */
    @Override
    public void loadAS(String source) throws Exception {
        setASLSrc(source);
        Path file = Path.of(source.startsWith(FILE) ? source.substring(FILE.length()) : source);
        try (Reader text = Files.newBufferedReader(file, StandardCharsets.UTF_8)) {
            parseAS(text, source);
        }
    }

    /** Called by Jason when the agent's own file has been read: the place where it adds what comes with every agent. */
    @Override
    public void loadKqmlPlans() throws Exception {
        String rules = option(this, RULES);
        if (rules != null) {
            parseRules(Path.of(rules));
        }
    }

    private void parseRules(Path rules) throws Exception {
        try (Reader text = Files.newBufferedReader(rules, StandardCharsets.UTF_8)) {
            parseAS(text, rules.getFileName().toString());
        }
    }

    /** From now on these rules advise, and none of those before.  The agent's own rules and beliefs stay. */
    void obey(Path rules) {
        ADVICE.forEach(getBB()::abolish);
        try {
            parseRules(rules);
            addInitialBelsInBB();
        } catch (Exception e) {
            throw new IllegalStateException("the rules " + rules + " cannot be read", e);
        }
    }

    /** An option that the .mas2j file or the job gives, without its quotes; null where there is none. */
    static String option(Agent agent, String name) {
        String value = agent.getTS().getSettings().getUserParameter(name);
        return value != null && value.length() > 1 && value.startsWith("\"") && value.endsWith("\"") ? value.substring(1, value.length() - 1) : value;
    }

    @Override
    public int buf(Collection<Literal> percepts) {
        if (percepts == null) {
            return 0;
        }
        Set<StructureWrapperForLiteral> wanted = new HashSet<>();
        percepts.forEach(p -> wanted.add(new StructureWrapperForLiteral(p)));
        List<Literal> gone = new ArrayList<>();
        Iterator<Literal> known = getBB().getPercepts();
        while (known.hasNext()) {
            Literal percept = known.next();
            if (!wanted.remove(new StructureWrapperForLiteral(percept))) {
                gone.add(percept);
            }
        }
        gone.sort(PerceptOrder.INSTANCE);
        List<Literal> come = percepts.stream().filter(p -> wanted.contains(new StructureWrapperForLiteral(p))).toList();
        for (Literal percept : gone) {
            getBB().remove(sensed(percept));
            raise(TEOperator.del, percept);
        }
        Set<PredicateIndicator> grown = new TreeSet<>();
        come.forEach(p -> grown.add(p.getPredicateIndicator()));
        List<Literal> again = percepts.stream().filter(p -> grown.contains(p.getPredicateIndicator())).toList();
        try {
            store(again);
        } catch (RevisionFailedException e) {
            throw new IllegalStateException(e);
        }
        come.forEach(p -> raise(TEOperator.add, p));
        return gone.size() + come.size();
    }

    /** A belief base puts what is new first, so what shall be found in order goes in backwards. */
    private void store(List<Literal> percepts) throws RevisionFailedException {
        percepts.forEach(p -> getBB().remove(sensed(p)));
        for (int i = percepts.size() - 1; i >= 0; i--) {
            getBB().add(sensed(percepts.get(i)));
        }
    }

    private void raise(TEOperator operator, Literal percept) {
        Trigger trigger = new Trigger(operator, TEType.belief, sensed(percept));
        if (getPL().hasCandidatePlan(trigger)) {
            getTS().updateEvents(new Event(trigger, Intention.EmptyInt));
        }
    }

    private static Literal sensed(Literal percept) {
        Literal own = percept.copy().forceFullLiteralImpl();
        own.setAnnots(null);
        own.addAnnot(BeliefBase.TPercept);
        return own;
    }
}

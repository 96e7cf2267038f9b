package rotra.jason;

import jason.asSemantics.Unifier;
import jason.asSyntax.Literal;
import jason.asSyntax.NumberTerm;
import jason.asSyntax.PredicateIndicator;
import jason.asSyntax.StringTerm;
import jason.asSyntax.Term;
import jason.asSyntax.VarTerm;
import jason.bb.DefaultBeliefBase;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.Iterator;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;

/**
 * Jason's belief base with an index on the arguments of beliefs and rule heads: hundreds of rules cost what the few that fit cost.
 *
 * <pre>
 *     advised(must, stop_at_white_line)?     of 300 rules for advised/2 only the five with that action are tried
 * </pre>
 *
 * In: what Jason puts in.  Out: the same answers in the same order; a query that is under way does not see what changes meanwhile.
 * Any change to a predicate drops its index.
 */
public final class IndexedBeliefBase extends DefaultBeliefBase {

    private static final long serialVersionUID = 1L;

    private final transient Map<PredicateIndicator, Index> indices = new HashMap<>();

    @Override
    protected boolean add(Literal belief, boolean atEnd) {
        indices.remove(belief.getPredicateIndicator());
        return super.add(belief, atEnd);
    }

    @Override
    public boolean remove(Literal belief) {
        indices.remove(belief.getPredicateIndicator());
        return super.remove(belief);
    }

    @Override
    public boolean abolish(jason.asSyntax.Atom namespace, PredicateIndicator predicate) {
        indices.remove(predicate);
        return super.abolish(namespace, predicate);
    }

    @Override
    public void clear() {
        indices.clear();
        super.clear();
    }

    @Override
    public Iterator<Literal> getCandidateBeliefs(Literal query, Unifier unifier) {
        if (query.isVar() || query.getArity() == 0 || query.getNS() != Literal.DefaultNS) {
            return super.getCandidateBeliefs(query, unifier);
        }
        Index index = indices.computeIfAbsent(query.getPredicateIndicator(), this::index);
        return index.candidates(query, unifier).iterator();
    }

    private Index index(PredicateIndicator predicate) {
        Iterator<Literal> all = getCandidateBeliefs(predicate);
        List<Literal> beliefs = new ArrayList<>();
        while (all != null && all.hasNext()) {
            beliefs.add(all.next());
        }
        return new Index(beliefs, predicate.getArity());
    }

    /** Per argument: the beliefs that may have that value there, in the order of the belief base. */
    private static final class Index {

        private final List<Literal> all;
        private final List<Map<Object, List<Literal>>> byValue = new ArrayList<>();
        private final List<List<Literal>> byVariable = new ArrayList<>();

        Index(List<Literal> beliefs, int arity) {
            all = beliefs;
            for (int i = 0; i < arity; i++) {
                Map<Object, List<Literal>> values = new HashMap<>();
                List<Literal> variable = new ArrayList<>();
                LinkedHashSet<Object> keys = new LinkedHashSet<>();
                for (Literal belief : beliefs) {
                    Object key = key(belief.getTerm(i), null);
                    if (key != null) {
                        keys.add(key);
                    }
                }
                keys.forEach(key -> values.put(key, new ArrayList<>()));
                for (Literal belief : beliefs) {
                    Object key = key(belief.getTerm(i), null);
                    if (key != null) {
                        values.get(key).add(belief);
                    } else {
                        variable.add(belief);
                        values.values().forEach(list -> list.add(belief));
                    }
                }
                byValue.add(values);
                byVariable.add(variable);
            }
        }

        List<Literal> candidates(Literal query, Unifier unifier) {
            List<Literal> fewest = all;
            for (int i = 0; i < byValue.size(); i++) {
                Object key = key(query.getTerm(i), unifier);
                if (key != null) {
                    List<Literal> found = byValue.get(i).getOrDefault(key, byVariable.get(i));
                    if (found.size() < fewest.size()) {
                        fewest = found;
                    }
                }
            }
            return fewest;
        }

        /** The value of an atom, number or string; null for what could be several values. */
        private static Object key(Term term, Unifier unifier) {
            if (term instanceof VarTerm variable) {
                Term value = unifier == null ? null : unifier.get(variable);
                return value == null || value instanceof VarTerm ? null : key(value, unifier);
            }
            if (term instanceof StringTerm text) {
                return "\"" + text.getString();
            }
            if (term instanceof NumberTerm) {
                return term.isNumeric() && !term.isArithExpr() ? numeric((NumberTerm) term) : null;
            }
            return term instanceof Literal atom && term.isAtom() && !atom.negated() && !atom.hasAnnot() ? atom.getFunctor() : null;
        }

        private static Object numeric(NumberTerm number) {
            try {
                return number.solve();
            } catch (jason.NoValueException e) {
                return null;
            }
        }
    }
}

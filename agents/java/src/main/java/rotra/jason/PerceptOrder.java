package rotra.jason;

import jason.NoValueException;
import jason.asSyntax.Literal;
import jason.asSyntax.NumberTerm;
import jason.asSyntax.Term;
import java.util.Comparator;

/** The order of percepts (model/README.md): functor, then argument by argument, numbers by value and before atoms. */
final class PerceptOrder implements Comparator<Literal> {

    static final PerceptOrder INSTANCE = new PerceptOrder();

    private PerceptOrder() { }

    @Override
    public int compare(Literal a, Literal b) {
        int c = a.getFunctor().compareTo(b.getFunctor());
        for (int i = 0; c == 0 && i < Math.min(a.getArity(), b.getArity()); i++) {
            c = terms(a.getTerm(i), b.getTerm(i));
        }
        return c != 0 ? c : Integer.compare(a.getArity(), b.getArity());
    }

    private static int terms(Term a, Term b) {
        if (a instanceof NumberTerm x) {
            return b instanceof NumberTerm y ? Double.compare(value(x), value(y)) : -1;
        }
        return b instanceof NumberTerm ? 1 : a.toString().compareTo(b.toString());
    }

    private static double value(NumberTerm number) {
        try {
            return number.solve();
        } catch (NoValueException e) {
            throw new IllegalArgumentException("a percept with an unbound number: " + number, e);
        }
    }
}

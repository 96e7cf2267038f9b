package rotra.jason;

import jason.asSyntax.ASSyntax;
import jason.asSyntax.Literal;
import jason.asSyntax.NumberTerm;
import jason.asSyntax.Structure;
import jason.asSyntax.Term;
import java.util.ArrayList;
import java.util.List;
import rotra.world.Act;
import rotra.world.Percept;

/**
 * The words of the world as Jason's terms, and back.
 *
 * <p>In and out: percepts, acts, literals.  What is no integer and no plain word is kept as its text, and so is no act.
 */
final class Words {

    private Words() { }

    static Literal literal(Percept percept) {
        return ASSyntax.createLiteral(percept.functor(), terms(percept.args()));
    }

    static Term term(Act act) {
        return act.args().isEmpty() ? ASSyntax.createAtom(act.functor()) : ASSyntax.createStructure(act.functor(), terms(act.args()));
    }

    private static Term[] terms(List<Object> args) {
        return args.stream().map(a -> a instanceof Integer n ? ASSyntax.createNumber(n) : ASSyntax.createAtom((String) a)).toArray(Term[]::new);
    }

    static Act act(Structure term) {
        List<Object> args = new ArrayList<>();
        for (int i = 0; i < term.getArity(); i++) {
            Term arg = term.getTerm(i);
            String text = arg.toString();
            args.add(arg instanceof NumberTerm && text.matches("-?\\d{1,9}") ? (Object) Integer.valueOf(text) : text);
        }
        return Act.of(term.getFunctor(), args);
    }

    /** The text of a literal without its annotations. */
    static String show(Literal literal) {
        if (!literal.hasAnnot()) {
            return literal.toString();
        }
        Literal bare = literal.copy();
        bare.clearAnnots();
        return bare.toString();
    }
}

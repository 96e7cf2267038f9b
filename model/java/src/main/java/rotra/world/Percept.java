package rotra.world;

import java.util.List;

/**
 * What a driver senses, as in {@code road(0,1,ahead)}; immutable.  An argument is an Integer or a String.
 *
 * <p>Order: functor, then arguments, integers by value and before atoms.  A class, not a record: its text is kept, and one
 * world hands out the same object for the same percept again and again, so a driver may keep what it made of it.
 */
public final class Percept implements Comparable<Percept> {

    private final String functor;
    private final List<Object> args;
    private final String text;

    public Percept(String functor, List<?> args) {
        this.functor = functor;
        this.args = List.copyOf(args);
        this.text = Words.show(functor, this.args);
    }

    public static Percept of(String functor, Object... args) {
        return new Percept(functor, List.of(args));
    }

    public static Percept parse(String text) {
        Words words = Words.parse(text);
        return new Percept(words.functor(), words.args());
    }

    public String functor() {
        return functor;
    }

    public List<Object> args() {
        return args;
    }

    /** Is this an instance of the pattern, in which {@code _} stands for anything? */
    boolean matches(Percept pattern) {
        if (!functor.equals(pattern.functor) || args.size() != pattern.args.size()) {
            return false;
        }
        for (int i = 0; i < args.size(); i++) {
            if (!"_".equals(pattern.args.get(i)) && !args.get(i).equals(pattern.args.get(i))) {
                return false;
            }
        }
        return true;
    }

    @Override
    public int compareTo(Percept other) {
        int c = functor.compareTo(other.functor);
        for (int i = 0; c == 0 && i < Math.min(args.size(), other.args.size()); i++) {
            c = Words.compare(args.get(i), other.args.get(i));
        }
        return c != 0 ? c : Integer.compare(args.size(), other.args.size());
    }

    @Override
    public boolean equals(Object other) {
        return this == other || other instanceof Percept p && text.equals(p.text);
    }

    @Override
    public int hashCode() {
        return text.hashCode();
    }

    @Override
    public String toString() {
        return text;
    }
}

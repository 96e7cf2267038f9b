package rotra.world;

import java.util.ArrayList;
import java.util.List;
import java.util.regex.Pattern;

/**
 * A ground word of the world, `functor(arg,..)`, from and to its text.
 *
 * <p>In: text.  Out: functor and arguments, Integer or String.  Left to others: what the word means (Percept, Act).
 */
record Words(String functor, List<Object> args) {

    private static final Pattern INTEGER = Pattern.compile("[+-]?\\d{1,9}");

    static Words parse(String text) {
        String t = text.strip();
        int open = t.indexOf('(');
        if (open < 0) {
            return new Words(required(t, text), List.of());
        }
        if (!t.endsWith(")")) {
            throw new IllegalArgumentException("not a word of the world: " + text);
        }
        List<Object> args = new ArrayList<>();
        String inside = t.substring(open + 1, t.length() - 1);
        int depth = 0;
        int from = 0;
        for (int i = 0; i < inside.length(); i++) {
            switch (inside.charAt(i)) {
                case '(', '[' -> depth++;
                case ')', ']' -> depth--;
                case ',' -> {
                    if (depth == 0) {
                        args.add(argument(inside.substring(from, i), text));
                        from = i + 1;
                    }
                }
                default -> { }
            }
        }
        args.add(argument(inside.substring(from), text));
        return new Words(required(t.substring(0, open).strip(), text), List.copyOf(args));
    }

    private static Object argument(String raw, String whole) {
        String t = required(raw.strip(), whole);
        return INTEGER.matcher(t).matches() ? (Object) Integer.valueOf(t) : t;
    }

    private static String required(String part, String whole) {
        if (part.isEmpty()) {
            throw new IllegalArgumentException("not a word of the world: " + whole);
        }
        return part;
    }

    static String show(String functor, List<?> args) {
        if (args.isEmpty()) {
            return functor;
        }
        StringBuilder out = new StringBuilder(functor).append('(');
        for (int i = 0; i < args.size(); i++) {
            out.append(i == 0 ? "" : ",").append(args.get(i));
        }
        return out.append(')').toString();
    }

    /** Integers by value, before all else by its text. */
    static int compare(Object a, Object b) {
        if (a instanceof Integer i && b instanceof Integer j) {
            return i.compareTo(j);
        }
        if (a instanceof Integer) {
            return -1;
        }
        return b instanceof Integer ? 1 : a.toString().compareTo(b.toString());
    }
}

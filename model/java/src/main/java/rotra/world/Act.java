package rotra.world;

import java.util.ArrayList;
import java.util.List;

/**
 * What a driver asks for, as in {@code change_lane(left,2)}; whether it can be done is asked of {@link #move}.
 */
public record Act(String functor, List<Object> args) {

    public static final Act WAIT = new Act("wait", List.of());

    public Act {
        args = List.copyOf(args);
    }

    public static Act of(String functor, List<?> args) {
        return new Act(functor, new ArrayList<>(args));
    }

    public static Act of(String functor, Object... args) {
        return new Act(functor, List.of(args));
    }

    public static Act parse(String text) {
        Words words = Words.parse(text);
        return new Act(words.functor(), words.args());
    }

    /** Every act there is, `wait` first, in the order of its text where the cells are at most nine. */
    public static List<Act> all(int topSpeed) {
        List<Act> acts = new ArrayList<>(List.of(WAIT));
        for (int n = 1; n <= topSpeed; n++) {
            acts.add(of("forward", n));
        }
        for (String functor : List.of("change_lane", "turn")) {
            for (Side side : Side.values()) {
                for (int n = 1; n <= topSpeed; n++) {
                    acts.add(of(functor, side.toString(), n));
                }
            }
        }
        return List.copyOf(acts);
    }

    /** The move this act asks for, or null where there is no such act in a world of that top speed. */
    Move move(int topSpeed) {
        return switch (functor) {
            case "wait" -> args.isEmpty() ? Move.NONE : null;
            case "forward" -> args.size() == 1 && cells(0, topSpeed) > 0 ? new Move(null, false, cells(0, topSpeed)) : null;
            case "change_lane", "turn" -> {
                Side side = args.size() == 2 ? side(args.get(0)) : null;
                yield side != null && cells(1, topSpeed) > 0 ? new Move(side, functor.equals("turn"), cells(1, topSpeed)) : null;
            }
            default -> null;
        };
    }

    private int cells(int index, int topSpeed) {
        return args.get(index) instanceof Integer n && n >= 1 && n <= topSpeed ? n : 0;
    }

    private static Side side(Object arg) {
        return "left".equals(arg) ? Side.LEFT : "right".equals(arg) ? Side.RIGHT : null;
    }

    @Override
    public String toString() {
        return Words.show(functor, args);
    }

    /** `cells` moves of one cell, the first to the side (null: ahead); `turns`: that side is then the heading. */
    record Move(Side side, boolean turns, int cells) {
        static final Move NONE = new Move(null, false, 0);
    }
}

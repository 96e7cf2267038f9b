package rotra.world;

import java.util.Locale;

/** A direction of travel, with the cell it leads to. */
public enum Heading {
    NORTH(0, -1), EAST(1, 0), SOUTH(0, 1), WEST(-1, 0);

    public final int dx;
    public final int dy;

    Heading(int dx, int dy) {
        this.dx = dx;
        this.dy = dy;
    }

    public Heading right() {
        return values()[(ordinal() + 1) % 4];
    }

    public Heading left() {
        return values()[(ordinal() + 3) % 4];
    }

    public Heading opposite() {
        return values()[(ordinal() + 2) % 4];
    }

    /** The heading on that side of this one. */
    public Heading to(Side side) {
        return side == Side.LEFT ? left() : right();
    }

    /** The name this heading has in the frame of a car that heads `frame`: ahead, back, left or right. */
    public String seenFrom(Heading frame) {
        return switch (Math.floorMod(ordinal() - frame.ordinal(), 4)) {
            case 0 -> "ahead";
            case 1 -> "right";
            case 2 -> "back";
            default -> "left";
        };
    }

    public static Heading of(String text) {
        return valueOf(text.toUpperCase(Locale.ROOT));
    }

    /** The word used in scenarios, percepts and traces. */
    @Override
    public String toString() {
        return name().toLowerCase(Locale.ROOT);
    }
}

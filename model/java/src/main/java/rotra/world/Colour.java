package rotra.world;

import java.util.Locale;

/** What a traffic light shows. */
public enum Colour {
    RED, RED_AMBER, GREEN, AMBER;

    public static Colour of(String text) {
        return valueOf(text.toUpperCase(Locale.ROOT));
    }

    @Override
    public String toString() {
        return name().toLowerCase(Locale.ROOT);
    }
}

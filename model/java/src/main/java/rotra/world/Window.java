package rotra.world;

import java.util.ArrayList;
import java.util.Collections;
import java.util.List;

/**
 * What can be seen from where: the part of perception that never changes, computed once and shared.
 *
 * <p>In: a scenario.  Out: sorted, ready-made percepts by own cell and heading.  Left to others: where the cars are and what
 * the lights show (World).
 */
final class Window {

    private final Scenario scenario;
    private final int width;
    private final int height;
    private final List<List<Percept>> roads;
    private final List<List<Percept>> stopLines;
    private final List<List<Percept>> cars;
    private final List<List<List<Percept>>> lights = new ArrayList<>();
    private final List<Percept> speeds = new ArrayList<>();
    private final List<Percept> headings = new ArrayList<>();
    final Percept drives;
    final Percept limit;
    final Percept task;

    Window(Scenario scenario) {
        this.scenario = scenario;
        width = scenario.width();
        height = scenario.height();
        int places = 4 * width * height;
        roads = new ArrayList<>(Collections.nCopies(places, null));
        stopLines = new ArrayList<>(Collections.nCopies(places, null));
        cars = new ArrayList<>(Collections.nCopies(places, null));
        for (Colour ignored : Colour.values()) {
            lights.add(new ArrayList<>(Collections.nCopies(places, null)));
        }
        for (int s = 0; s <= scenario.topSpeed(); s++) {
            speeds.add(Percept.of("speed", s));
        }
        for (Heading heading : Heading.values()) {
            headings.add(Percept.of("heading", heading.toString()));
        }
        drives = Percept.of("drives", scenario.drives().toString());
        limit = Percept.of("limit", scenario.limit());
        task = Percept.of("task", scenario.driver().task());
    }

    Percept heading(Heading heading) {
        return headings.get(heading.ordinal());
    }

    Percept speed(int speed) {
        return speeds.get(speed);
    }

    /** Every road cell in the window, once for each way of travel it permits. */
    List<Percept> roads(int x, int y, Heading heading) {
        int place = place(x, y, heading);
        List<Percept> seen = roads.get(place);
        if (seen == null) {
            List<Percept> found = new ArrayList<>();
            forEach(heading, (r, a, dx, dy) -> scenario.flows(Math.floorMod(x + dx, width), Math.floorMod(y + dy, height))
                    .forEach(flow -> found.add(Percept.of("road", r, a, flow.seenFrom(heading)))));
            seen = sorted(found);
            roads.set(place, seen);
        }
        return seen;
    }

    /** Every stop line in the window of a light that faces the car. */
    List<Percept> stopLines(int x, int y, Heading heading) {
        int place = place(x, y, heading);
        List<Percept> seen = stopLines.get(place);
        if (seen == null) {
            List<Percept> found = new ArrayList<>();
            for (Scenario.Light light : scenario.lights()) {
                if (faces(light, heading)) {
                    images("stop_line", light.stopLine().x() - x, light.stopLine().y() - y, heading, found);
                }
            }
            seen = sorted(found);
            stopLines.set(place, seen);
        }
        return seen;
    }

    /** Each place of the window where a car shows that is (dx,dy) cells from the own cell. */
    List<Percept> car(int dx, int dy, Heading heading) {
        int place = place(Math.floorMod(dx, width), Math.floorMod(dy, height), heading);
        List<Percept> seen = cars.get(place);
        if (seen == null) {
            List<Percept> found = new ArrayList<>();
            images("car", dx, dy, heading, found);
            seen = sorted(found);
            cars.set(place, seen);
        }
        return seen;
    }

    /** Each place of the window where a light shows that is (dx,dy) cells from the own cell. */
    List<Percept> light(int dx, int dy, Heading heading, Colour colour) {
        int place = place(Math.floorMod(dx, width), Math.floorMod(dy, height), heading);
        List<Percept> seen = lights.get(colour.ordinal()).get(place);
        if (seen == null) {
            List<Percept> found = new ArrayList<>();
            images("light", dx, dy, heading, found, colour.toString());
            seen = sorted(found);
            lights.get(colour.ordinal()).set(place, seen);
        }
        return seen;
    }

    static boolean faces(Scenario.Light light, Heading heading) {
        return light.faces() == heading.opposite();
    }

    static List<Percept> sorted(List<Percept> percepts) {
        return percepts.stream().sorted().distinct().toList();
    }

    private int place(int x, int y, Heading heading) {
        return (heading.ordinal() * height + y) * width + x;
    }

    private void images(String functor, int dx, int dy, Heading heading, List<Percept> found, Object... more) {
        forEach(heading, (r, a, wx, wy) -> {
            if (Math.floorMod(wx - dx, width) == 0 && Math.floorMod(wy - dy, height) == 0) {
                List<Object> args = new ArrayList<>(List.of(r, a));
                args.addAll(List.of(more));
                found.add(new Percept(functor, args));
            }
        });
    }

    private interface Place {
        void at(int right, int ahead, int dx, int dy);
    }

    private void forEach(Heading heading, Place place) {
        Heading right = heading.right();
        for (int r = -scenario.radius(); r <= scenario.radius(); r++) {
            for (int a = -scenario.radius(); a <= scenario.radius(); a++) {
                place.at(r, a, r * right.dx + a * heading.dx, r * right.dy + a * heading.dy);
            }
        }
    }
}

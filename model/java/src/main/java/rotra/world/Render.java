package rotra.world;

import java.util.List;
import java.util.Map;
import java.util.StringJoiner;

/**
 * A world as text, plain characters only.
 *
 * <pre>
 *     tl red   driver 2,7 north 0
 *      .  .  ^  .  .
 *      .  R  ^_ .  .
 *      .  .  D  .  .
 * </pre>
 *
 * `D` the driver, `c` another car (its last digit, if its name ends in one), `X` a crash, `_` a stop line; a light shows
 * the first letter of its colour, `r` for red and amber together.
 */
public final class Render {

    private Render() { }

    public static String text(World world) {
        Scenario scenario = world.scenario();
        WorldState state = world.snapshot();
        StringBuilder out = new StringBuilder(heading(state)).append('\n');
        if (scenario.isOpen()) {
            return out.append(world.perceive(scenario.driver().name())).append('\n').toString();
        }
        List<String> hesitating = world.hesitating();
        if (!hesitating.isEmpty()) {
            out.append("hesitating: ").append(String.join(", ", hesitating)).append('\n');
        }
        for (int y = 0; y < scenario.height(); y++) {
            StringBuilder row = new StringBuilder();
            for (int x = 0; x < scenario.width(); x++) {
                Cell cell = new Cell(x, y);
                boolean line = scenario.lights().stream().anyMatch(light -> light.stopLine().equals(cell));
                row.append(' ').append(mark(scenario, state, cell)).append(line ? '_' : ' ');
            }
            out.append(row.toString().stripTrailing()).append('\n');
        }
        return out.toString();
    }

    private static String heading(WorldState state) {
        StringJoiner out = new StringJoiner("   ");
        state.lights().forEach((name, colour) -> out.add(name + " " + colour));
        state.cars().forEach((name, car) -> out.add(name + " " + car.x() + "," + car.y() + " " + car.heading() + " " + car.speed()
                + (car.crashed() ? " crashed" : "")));
        if (state.finished()) {
            out.add("finished");
        }
        return out.toString();
    }

    private static char mark(Scenario scenario, WorldState state, Cell cell) {
        char mark = 0;
        for (Map.Entry<String, WorldState.Car> entry : state.cars().entrySet()) {
            WorldState.Car car = entry.getValue();
            if (car.x() == cell.x() && car.y() == cell.y()) {
                if (car.crashed()) {
                    return 'X';
                }
                char end = entry.getKey().charAt(entry.getKey().length() - 1);
                mark = entry.getKey().equals(scenario.driver().name()) ? 'D' : Character.isDigit(end) ? end : 'c';
            }
        }
        if (mark != 0) {
            return mark;
        }
        for (Scenario.Light light : scenario.lights()) {
            if (light.at().equals(cell)) {
                String colour = state.lights().get(light.name());
                return colour.equals("red_amber") ? 'r' : Character.toUpperCase(colour.charAt(0));
            }
        }
        return scenario.isRoad(cell.x(), cell.y()) ? scenario.rows().get(cell.y()).charAt(cell.x()) : '.';
    }
}

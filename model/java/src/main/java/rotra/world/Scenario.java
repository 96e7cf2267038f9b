package rotra.world;

import java.util.ArrayList;
import java.util.List;
import java.util.function.Function;
import java.util.stream.IntStream;
import javax.json.JsonArray;
import javax.json.JsonNumber;
import javax.json.JsonObject;
import javax.json.JsonString;
import javax.json.JsonValue;
import javax.json.JsonValue.ValueType;

/**
 * A grid, its lights, cars, task and goal, and which of them may vary.
 *
 * <p>In: the resolved JSON that the Python side writes, already checked there.  Out: immutable values.  Left to others:
 * telling a user what is wrong with a scenario file (frontends/scenario.py).
 */
public record Scenario(String id, Side drives, int radius, int limit, int topSpeed, List<String> rows, List<Light> lights,
                       Driver driver, List<ScriptedCar> traffic, Goal goal, List<Percept> percepts, List<List<Percept>> exclusions) {

    /** So many steps of one colour. */
    public record Shown(Colour colour, int steps) { }

    /** A light: its own cell, the cell of its stop line, the way it faces, what it shows step by step. */
    public record Light(String name, Cell at, Cell stopLine, Heading faces, List<Shown> cycle, Varied<Integer> phase) {

        static final List<Shown> DEFAULT_CYCLE = List.of(new Shown(Colour.RED, 4), new Shown(Colour.RED_AMBER, 1),
                new Shown(Colour.GREEN, 4), new Shown(Colour.AMBER, 1));

        public int period() {
            return cycle.stream().mapToInt(Shown::steps).sum();
        }

        /** What it shows at that position of its cycle. */
        public Colour colour(int position) {
            int left = Math.floorMod(position, period());
            for (Shown shown : cycle) {
                if (left < shown.steps()) {
                    return shown.colour();
                }
                left -= shown.steps();
            }
            throw new IllegalStateException("empty cycle of " + name);
        }
    }

    /** The car under test. */
    public record Driver(String name, Varied<Cell> at, Heading heading, String task) { }

    /** A car that goes straight on, `speed` cells a step, unless it hesitates or its way is taken. */
    public record ScriptedCar(String name, Varied<Cell> at, Heading heading, Varied<Integer> speed, Varied<Boolean> hesitates) { }

    private static final String ROAD = "^v<>+";

    public Scenario {
        rows = List.copyOf(rows);
        lights = List.copyOf(lights);
        traffic = List.copyOf(traffic);
        percepts = percepts.stream().sorted().distinct().toList();
        exclusions = exclusions.stream().map(List::copyOf).toList();
        int width = rows.isEmpty() ? 0 : rows.get(0).length();
        if (rows.stream().anyMatch(row -> row.length() != width)) {
            throw new IllegalArgumentException("the rows of scenario " + id + " differ in length");
        }
    }

    public boolean isOpen() {
        return rows.isEmpty();
    }

    public int width() {
        return rows.isEmpty() ? 0 : rows.get(0).length();
    }

    public int height() {
        return rows.size();
    }

    /** A cell with a road mark and no light on it. */
    public boolean isRoad(int x, int y) {
        return ROAD.indexOf(mark(x, y)) >= 0 && lights.stream().noneMatch(light -> light.at().x() == x && light.at().y() == y);
    }

    /** The ways of travel that a cell permits. */
    public List<Heading> flows(int x, int y) {
        if (!isRoad(x, y)) {
            return List.of();
        }
        return switch (mark(x, y)) {
            case '^' -> List.of(Heading.NORTH);
            case 'v' -> List.of(Heading.SOUTH);
            case '<' -> List.of(Heading.WEST);
            case '>' -> List.of(Heading.EAST);
            default -> List.of(Heading.values());
        };
    }

    private char mark(int x, int y) {
        char mark = rows.get(y).charAt(x);
        return mark == 'V' ? 'v' : mark;
    }

    public Light light(String name) {
        return lights.stream().filter(light -> light.name().equals(name)).findFirst()
                .orElseThrow(() -> new IllegalArgumentException("scenario " + id + " has no light " + name));
    }

    // -- from JSON ------------------------------------------------------------------------------------------------------

    public static Scenario read(JsonObject json) {
        int limit = json.getInt("limit", 1);
        List<String> rows = given(json, "rows") ? each(json.getJsonArray("rows"), Scenario::text)
                : json.getString("grid", "").lines().toList();
        return new Scenario(json.getString("id", "scenario"), Side.of(json.getString("drives", "left")), json.getInt("radius", 3), limit,
                given(json, "top_speed") ? json.getInt("top_speed") : limit + 1,
                rows, list(json, "lights", v -> light(v.asJsonObject())),
                given(json, "driver") ? driver(json.getJsonObject("driver")) : new Driver("driver", fixed(new Cell(0, 0)), Heading.NORTH, "straight_on"),
                list(json, "traffic", v -> car(v.asJsonObject())), given(json, "goal") ? goal(json.getJsonObject("goal")) : new Goal.None(),
                list(json, "percepts", v -> Percept.parse(text(v))),
                list(json, "percept_exclusions", group -> each(group.asJsonArray(), v -> Percept.parse(text(v)))));
    }

    private static Light light(JsonObject json) {
        List<Shown> cycle = !given(json, "cycle") ? Light.DEFAULT_CYCLE : json.get("cycle").getValueType() == ValueType.OBJECT
                ? json.getJsonObject("cycle").entrySet().stream().map(e -> new Shown(Colour.of(e.getKey()), integer(e.getValue()))).toList()
                : each(json.getJsonArray("cycle"), v -> new Shown(Colour.of(text(v.asJsonArray().get(0))), v.asJsonArray().getInt(1)));
        int period = cycle.stream().mapToInt(Shown::steps).sum();
        return new Light(json.getString("name"), cell(json.get("at")), cell(json.get("stop_line")), Heading.of(json.getString("faces")), cycle,
                given(json, "phase") ? varied(json.get("phase"), Scenario::integer, IntStream.range(0, period).boxed().toList()) : fixed(0));
    }

    private static Driver driver(JsonObject json) {
        return new Driver(json.getString("name", "driver"), given(json, "at") ? varied(json.get("at"), Scenario::cell, List.of()) : fixed(new Cell(0, 0)),
                Heading.of(json.getString("heading", "north")), json.getString("task", "straight_on"));
    }

    private static ScriptedCar car(JsonObject json) {
        return new ScriptedCar(json.getString("name"), varied(json.get("at"), Scenario::cell, List.of()), Heading.of(json.getString("heading", "north")),
                given(json, "speed") ? varied(json.get("speed"), Scenario::integer, List.of()) : fixed(1),
                given(json, "hesitates") ? varied(json.get("hesitates"), v -> v.getValueType() == ValueType.TRUE, List.of(false, true)) : fixed(false));
    }

    private static Goal goal(JsonObject json) {
        if (given(json, "in")) {
            return new Goal.InCells(each(json.getJsonArray("in"), Scenario::cell));
        }
        if (given(json, "beyond")) {
            JsonObject beyond = json.getJsonObject("beyond");
            return new Goal.Beyond(beyond.getString("light"), beyond.getInt("cells"));
        }
        JsonObject overtaken = json.getJsonObject("overtaken");
        return new Goal.Overtaken(overtaken.getString("car"), overtaken.getInt("within"));
    }

    /** A plain value, or {"published": .., "all": [..]}; `any` (or `true` for a flag) instead of the list stands for `whole`. */
    private static <T> Varied<T> varied(JsonValue json, Function<JsonValue, T> value, List<T> whole) {
        if (json.getValueType() != ValueType.OBJECT) {
            return fixed(value.apply(json));
        }
        JsonObject both = json.asJsonObject();
        T published = value.apply(both.get("published"));
        JsonValue all = both.get("all");
        if (all == null || all.getValueType() == ValueType.NULL || all.getValueType() == ValueType.FALSE) {
            return fixed(published);
        }
        return new Varied<>(published, all.getValueType() == ValueType.ARRAY ? each(all.asJsonArray(), value) : whole);
    }

    private static <T> Varied<T> fixed(T value) {
        return new Varied<>(value, List.of(value));
    }

    private static boolean given(JsonObject json, String key) {
        return json.containsKey(key) && json.get(key).getValueType() != ValueType.NULL;
    }

    private static <T> List<T> list(JsonObject json, String key, Function<JsonValue, T> value) {
        return given(json, key) ? each(json.getJsonArray(key), value) : List.of();
    }

    private static <T> List<T> each(JsonArray json, Function<JsonValue, T> value) {
        List<T> out = new ArrayList<>();
        json.forEach(v -> out.add(value.apply(v)));
        return List.copyOf(out);
    }

    static Cell cell(JsonValue json) {
        JsonArray pair = json.asJsonArray();
        return new Cell(pair.getInt(0), pair.getInt(1));
    }

    static int integer(JsonValue json) {
        return ((JsonNumber) json).intValueExact();
    }

    private static String text(JsonValue json) {
        return ((JsonString) json).getString();
    }
}

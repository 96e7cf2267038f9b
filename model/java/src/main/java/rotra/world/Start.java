package rotra.world;

import java.util.Collections;
import java.util.HashSet;
import java.util.LinkedHashMap;
import java.util.Map;
import java.util.Random;
import java.util.Set;
import java.util.function.Function;
import javax.json.JsonObject;
import javax.json.JsonValue;

/**
 * The choices the world makes once, before the first step.  What is left out (null, or not in a map) is as published.
 */
public record Start(int[] driverAt, Map<String, Integer> phases, Map<String, int[]> trafficAt, Map<String, Integer> trafficSpeed) {

    private static final int DRAWS = 10_000;

    public Start {
        phases = Collections.unmodifiableMap(new LinkedHashMap<>(phases));
        trafficAt = Collections.unmodifiableMap(new LinkedHashMap<>(trafficAt));
        trafficSpeed = Collections.unmodifiableMap(new LinkedHashMap<>(trafficSpeed));
    }

    public static Start published(Scenario scenario) {
        return draw(scenario, null);
    }

    /** Any start of the scenario in which no two cars share a cell, every choice drawn evenly. */
    public static Start random(Scenario scenario, Random random) {
        for (int i = 0; i < DRAWS; i++) {
            Start start = draw(scenario, random);
            Set<Cell> taken = new HashSet<>();
            taken.add(new Cell(start.driverAt[0], start.driverAt[1]));
            if (start.trafficAt.values().stream().allMatch(at -> taken.add(new Cell(at[0], at[1])))) {
                return start;
            }
        }
        throw new IllegalArgumentException("scenario " + scenario.id() + " has no start in which every car has its own cell");
    }

    private static Start draw(Scenario scenario, Random random) {
        Map<String, Integer> phases = new LinkedHashMap<>();
        Map<String, int[]> at = new LinkedHashMap<>();
        Map<String, Integer> speed = new LinkedHashMap<>();
        int[] driver = pair(pick(scenario.driver().at(), random));
        scenario.lights().forEach(light -> phases.put(light.name(), pick(light.phase(), random)));
        for (Scenario.ScriptedCar car : scenario.traffic()) {
            at.put(car.name(), pair(pick(car.at(), random)));
            speed.put(car.name(), pick(car.speed(), random));
        }
        return new Start(driver, phases, at, speed);
    }

    private static <T> T pick(Varied<T> varied, Random random) {
        return random == null ? varied.published() : varied.any(random);
    }

    private static int[] pair(Cell cell) {
        return new int[] {cell.x(), cell.y()};
    }

    /** {"driverAt": [x,y], "phases": {light: n}, "trafficAt": {car: [x,y]}, "trafficSpeed": {car: n}}, each of them optional. */
    public static Start read(JsonObject json) {
        JsonValue driver = json.get("driverAt");
        return new Start(driver == null || driver == JsonValue.NULL ? null : pair(Scenario.cell(driver)), map(json, "phases", Scenario::integer),
                map(json, "trafficAt", v -> pair(Scenario.cell(v))), map(json, "trafficSpeed", Scenario::integer));
    }

    private static <T> Map<String, T> map(JsonObject json, String key, Function<JsonValue, T> value) {
        Map<String, T> out = new LinkedHashMap<>();
        JsonValue given = json.get(key);
        if (given != null && given != JsonValue.NULL) {
            given.asJsonObject().forEach((name, v) -> out.put(name, value.apply(v)));
        }
        return out;
    }
}

package rotra.jason;

import java.util.ArrayList;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.Random;
import javax.json.Json;
import javax.json.JsonArray;
import javax.json.JsonObject;
import javax.json.JsonObjectBuilder;
import javax.json.JsonString;
import javax.json.JsonValue;
import rotra.world.Percept;
import rotra.world.Scenario;
import rotra.world.Start;

/**
 * A run that is asked for: which agent, under which rules, in which world, with which choices of the world.
 *
 * <p>In: {@code {"agent", "rules", "world", "start", "seed", "choices", "percepts", "steps", "until", "trace", "cap",
 * "then"}}, all but the first three may be left out.  `then`: from which step on which other rules hold.  `choices`: per step who hesitates; `percepts`: per step what is sensed, in an open scenario.  What is
 * not given comes from the seed; without a seed the start is the published one and nobody hesitates.
 */
record Job(String agent, String rules, Scenario world, Start start, Random chance, List<List<String>> choices, List<List<Percept>> percepts,
           int steps, String until, boolean trace, int cap, Map<Integer, OtherRules> then) {

    /** Rules that take the place of those before: their name in the trace, and their file. */
    record OtherRules(String name, String file) { }

    static final int CAP = 500;

    static Job read(JsonObject json) {
        Scenario world = Scenario.read(json.getJsonObject("world"));
        Random chance = given(json, "seed") ? new Random(json.getJsonNumber("seed").longValue()) : null;
        Start start = given(json, "start") ? Start.read(json.getJsonObject("start"))
                : chance != null ? Start.random(world, chance) : Start.published(world);
        // an open world has to sense something: without a seed it is chance too, always the same
        Random choice = chance == null && world.isOpen() ? new Random(0) : chance;
        return new Job(json.getString("agent"), json.getString("rules"), world, start, choice,
                given(json, "choices") ? lists(json.getJsonArray("choices")) : null,
                given(json, "percepts") ? lists(json.getJsonArray("percepts")).stream().map(step -> step.stream().map(Percept::parse).toList()).toList() : null,
                json.getInt("steps", 40), given(json, "until") ? json.getString("until") : "", json.getBoolean("trace", true), json.getInt("cap", CAP),
                given(json, "then") ? changes(json.getJsonArray("then")) : Map.of());
    }

    private static Map<Integer, OtherRules> changes(JsonArray json) {
        Map<Integer, OtherRules> out = new HashMap<>();
        for (JsonObject change : json.getValuesAs(JsonObject.class)) {
            out.put(change.getInt("at"), new OtherRules(change.getString("name"), change.getString("rules")));
        }
        return out;
    }

    private static boolean given(JsonObject json, String key) {
        return json.containsKey(key) && json.get(key) != JsonValue.NULL;
    }

    private static List<List<String>> lists(JsonArray json) {
        List<List<String>> out = new ArrayList<>();
        for (JsonValue step : json) {
            out.add(step.asJsonArray().getValuesAs(JsonString.class).stream().map(JsonString::getString).toList());
        }
        return out;
    }

    /** The start as {@link Start#read} takes it. */
    JsonObject startJson() {
        JsonObjectBuilder phases = Json.createObjectBuilder();
        start.phases().forEach(phases::add);
        JsonObjectBuilder at = Json.createObjectBuilder();
        start.trafficAt().forEach((name, cell) -> at.add(name, Json.createArrayBuilder().add(cell[0]).add(cell[1])));
        JsonObjectBuilder speed = Json.createObjectBuilder();
        start.trafficSpeed().forEach(speed::add);
        JsonObjectBuilder out = Json.createObjectBuilder().add("phases", phases).add("trafficAt", at).add("trafficSpeed", speed);
        if (start.driverAt() != null) {
            out.add("driverAt", Json.createArrayBuilder().add(start.driverAt()[0]).add(start.driverAt()[1]));
        }
        return out.build();
    }
}

import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.stream.Collectors;
import javax.json.Json;
import javax.json.JsonObject;
import javax.json.JsonString;
import rotra.world.Act;
import rotra.world.Percept;
import rotra.world.Scenario;
import rotra.world.Start;
import rotra.world.World;

/**
 * Drives the Java world for tests/test_world_java.py.
 *
 * <p>In: a JSON list of {scenario, start, steps: [{hesitates, act}]}.  Out: for each, one line a step: the percepts, then the state after it.
 */
public class WorldSteps {

    public static void main(String[] args) {
        StringBuilder out = new StringBuilder();
        for (JsonObject job : Json.createReader(System.in).readArray().getValuesAs(JsonObject.class)) {
            World world = World.start(Scenario.read(job.getJsonObject("scenario")), Start.read(job.getJsonObject("start")));
            for (JsonObject step : job.getJsonArray("steps").getValuesAs(JsonObject.class)) {
                List<JsonString> hesitates = step.getJsonArray("hesitates").getValuesAs(JsonString.class);
                world.setHesitating(hesitates.stream().map(JsonString::getString).collect(Collectors.<String>toSet()));
                String seen = world.perceive("driver").stream().map(Percept::toString).collect(Collectors.joining(" "));
                world.step(Map.of("driver", Act.parse(step.getString("act"))));
                out.append(Json.createObjectBuilder().add("percepts", seen).add("state", world.snapshot().toJson()).build()).append('\n');
            }
        }
        System.out.print(out);
    }
}

package rotra.jason;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.io.StringReader;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.List;
import javax.json.Json;
import javax.json.JsonObject;
import javax.json.JsonString;
import org.junit.jupiter.api.BeforeAll;
import org.junit.jupiter.api.Test;
import org.junit.jupiter.api.io.TempDir;

/** Small drivers on a road of one lane: what becomes of their acts, in which order their percepts come, when they do not rest. */
class LockstepTest {

    private static final String ROAD = """
            {"id": "lane", "drives": "left", "radius": 1, "limit": 1, "top_speed": 2, "rows": ["^", "^", "^", "^", "^", "^"],
             "driver": {"name": "driver", "at": [0, 5], "heading": "north", "task": "straight_on"},
             "traffic": [], "lights": [], "goal": {"in": [[0, 2]]}}""";

    @TempDir
    Path folder;

    @BeforeAll
    static void quiet() {
        Quiet.please();
        Includes.use();
    }

    private JsonObject drive(String agent, String more) throws Exception {
        Path file = Files.writeString(folder.resolve("driver.asl"), agent);
        Path rules = Files.writeString(folder.resolve("advice.asl"), "");
        String job = "{\"agent\": \"%s\", \"rules\": \"%s\", \"world\": %s, \"steps\": 4 %s}".formatted(file, rules, ROAD, more);
        return new Lockstep(Job.read(Json.createReader(new StringReader(job)).readObject())).run();
    }

    private static List<JsonObject> steps(JsonObject run) {
        return run.getJsonArray("steps").getValuesAs(JsonObject.class);
    }

    private static String act(JsonObject step) {
        return step.getJsonObject("acts").getString("driver");
    }

    private static List<String> beliefs(JsonObject step) {
        return step.getJsonArray("beliefs").getValuesAs(JsonString::getString);
    }

    @Test
    void anActIsDoneAndTheGoalIsReached() throws Exception {
        List<JsonObject> steps = steps(drive("!go. +!go <- forward(1); !go.", ", \"until\": \"finished\""));
        assertEquals("forward(1)", act(steps.get(0)));
        assertEquals(4, steps.get(1).getJsonObject("cars").getJsonObject("driver").getInt("y"));
        assertTrue(steps.get(steps.size() - 1).getBoolean("finished"));
    }

    @Test
    void theSecondActOfAStepIsBusy() throws Exception {
        List<JsonObject> steps = steps(drive("!a. !b. +!a <- wait; !a. +!b <- forward(1); +done. -!b[busy] <- +was_busy.", ""));
        assertEquals("wait", act(steps.get(0)));
        assertEquals("[\"forward(1)\"]", steps.get(0).getJsonArray("busy").toString());
        assertEquals(List.of("was_busy"), beliefs(steps.get(1)));
    }

    @Test
    void anActThatDoesNotExistFailsAndTheStepIsWait() throws Exception {
        List<JsonObject> steps = steps(drive("!go. +!go <- forward(7). -!go[no_such_act] <- +told.", ""));
        assertEquals("wait", act(steps.get(0)));
        assertEquals(List.of("told"), beliefs(steps.get(1)));
    }

    @Test
    void perceptsComeInOrderAndWhatGoesComesFirst() throws Exception {
        String agent = "!go. +!go <- forward(1); !go. +speed(S) <- ?seen(L); -+seen([came(S)|L]). -speed(S) <- ?seen(L); -+seen([went(S)|L]). "
                + "+limit(_) <- ?seen(L); -+seen([limit|L]). seen([]).";
        List<JsonObject> steps = steps(drive(agent, ""));
        assertEquals(List.of("seen([came(0),limit])"), beliefs(steps.get(0)));
        assertEquals(List.of("seen([came(1),went(0),came(0),limit])"), beliefs(steps.get(1)));
    }

    @Test
    void whoNeverRestsIsStopped() throws Exception {
        JsonObject run = drive("!go. +!go <- !go.", "");
        assertEquals("restless", run.getJsonObject("fault").getString("kind"));
        assertTrue(steps(run).get(0).getBoolean("restless"));
    }

    @Test
    void whoHasCrashedDoesNothingMore() throws Exception {
        String wide = ROAD.replace("\"^\"", "\"^.\"");
        Path file = Files.writeString(folder.resolve("driver.asl"), "!go. +!go <- change_lane(right,1); !go.");
        Path rules = Files.writeString(folder.resolve("advice.asl"), "");
        String job = "{\"agent\": \"%s\", \"rules\": \"%s\", \"world\": %s, \"steps\": 3}".formatted(file, rules, wide);
        List<JsonObject> steps = steps(new Lockstep(Job.read(Json.createReader(new StringReader(job)).readObject())).run());
        assertEquals("change_lane(right,1)", act(steps.get(0)));
        assertEquals("wait", act(steps.get(1)));
        assertTrue(steps.get(1).getJsonObject("cars").getJsonObject("driver").getBoolean("crashed"));
        assertTrue(steps.get(1).getJsonArray("percepts").isEmpty());
    }

    @Test
    void theSameJobGivesTheSameTrace() throws Exception {
        String agent = "!go. +!go : speed(0) <- forward(1); !go. +!go <- wait; !go.";
        assertEquals(steps(drive(agent, ", \"seed\": 3")), steps(drive(agent, ", \"seed\": 3")));
    }
}

package rotra.world;

import java.io.StringReader;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.function.Consumer;
import javax.json.Json;
import javax.json.JsonObject;

/** Small worlds for tests, in JSON with single quotes. */
final class Worlds {

    private Worlds() { }

    static JsonObject json(String text) {
        return Json.createReader(new StringReader(text.replace('\'', '"'))).readObject();
    }

    /** A scenario of these rows; `more` are further fields, each beginning with a comma. */
    static Scenario scenario(String more, String... rows) {
        List<String> quoted = new ArrayList<>();
        for (String row : rows) {
            quoted.add("'" + row + "'");
        }
        return Scenario.read(json("{'id':'t','limit':3,'rows':" + quoted + more + "}"));
    }

    static String driver(int x, int y, String heading) {
        return ",'driver':{'at':[" + x + "," + y + "],'heading':'" + heading + "','task':'straight_on'}";
    }

    static String traffic(String... cars) {
        return ",'traffic':[" + String.join(",", cars) + "]";
    }

    static String car(String name, int x, int y, String heading, int speed) {
        return "{'name':'" + name + "','at':[" + x + "," + y + "],'heading':'" + heading + "','speed':" + speed
                + ",'hesitates':{'published':false,'all':[false,true]}}";
    }

    static World world(Scenario scenario) {
        return World.start(scenario, Start.published(scenario));
    }

    static World world(String more, String... rows) {
        return world(scenario(more, rows));
    }

    static boolean step(World world, String act) {
        return world.step(Map.of("driver", Act.parse(act))).get("driver");
    }

    static void step(World world, String act, String... hesitating) {
        world.setHesitating(Set.of(hesitating));
        step(world, act);
    }

    /** "x,y,heading,speed" and "!" after a crash. */
    static String at(World world, String car) {
        WorldState.Car c = world.snapshot().cars().get(car);
        return c.x() + "," + c.y() + "," + c.heading() + "," + c.speed() + (c.crashed() ? "!" : "");
    }

    static List<String> seen(World world, String functor) {
        return world.perceive("driver").stream().filter(p -> p.functor().equals(functor)).map(Percept::toString).toList();
    }

    static void times(int n, Consumer<Integer> what) {
        for (int i = 0; i < n; i++) {
            what.accept(i);
        }
    }
}

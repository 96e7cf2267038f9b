package rotra.world;

import java.util.Collections;
import java.util.LinkedHashMap;
import java.util.Map;
import javax.json.Json;
import javax.json.JsonObject;
import javax.json.JsonObjectBuilder;

/** What a trace shows of the world at one step, before anybody moves.  Lights and cars are in the scenario's order, the driver first. */
public record WorldState(Map<String, String> lights, Map<String, Car> cars, boolean finished) {

    /** `speed`: the cells moved in the last step. */
    public record Car(int x, int y, String heading, int speed, boolean crashed) { }

    public WorldState {
        lights = Collections.unmodifiableMap(new LinkedHashMap<>(lights));
        cars = Collections.unmodifiableMap(new LinkedHashMap<>(cars));
    }

    public JsonObject toJson() {
        JsonObjectBuilder shown = Json.createObjectBuilder();
        lights.forEach(shown::add);
        JsonObjectBuilder all = Json.createObjectBuilder();
        cars.forEach((name, car) -> all.add(name, Json.createObjectBuilder().add("x", car.x()).add("y", car.y()).add("heading", car.heading())
                .add("speed", car.speed()).add("crashed", car.crashed())));
        return Json.createObjectBuilder().add("lights", shown).add("cars", all).add("finished", finished).build();
    }
}

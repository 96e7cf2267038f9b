package rotra.world;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertTrue;
import static rotra.world.Worlds.car;
import static rotra.world.Worlds.driver;
import static rotra.world.Worlds.json;
import static rotra.world.Worlds.scenario;
import static rotra.world.Worlds.step;
import static rotra.world.Worlds.traffic;
import static rotra.world.Worlds.world;

import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import org.junit.jupiter.api.Test;

class GoalAndLightTest {

    private static final String[] LANES = {".++.", ".++.", ".++.", ".++.", ".++.", ".++.", ".++.", ".++."};

    private static String light(String more) {
        return ",'lights':[{'name':'tl','at':[0,5],'stop_line':[1,5],'faces':'south'" + more + "}]";
    }

    private static List<String> colours(World world, int steps) {
        List<String> shown = new ArrayList<>();
        Worlds.times(steps, i -> {
            shown.add(world.snapshot().lights().get("tl"));
            step(world, "wait");
        });
        return shown;
    }

    @Test
    void theDefaultCycle() {
        List<String> once = List.of("red", "red", "red", "red", "red_amber", "green", "green", "green", "green", "amber");
        List<String> twice = new ArrayList<>(once);
        twice.addAll(once);
        assertEquals(twice, colours(world(driver(1, 7, "north") + light(""), LANES), 20));
    }

    @Test
    void thePhaseIsThePositionShownInStepOne() {
        assertEquals(List.of("red_amber", "green"), colours(world(driver(1, 7, "north") + light(",'phase':4"), LANES), 2));
        assertEquals(List.of("amber", "red"), colours(world(driver(1, 7, "north") + light(",'phase':{'published':9,'all':[0,9]}"), LANES), 2));
        Scenario scenario = scenario(driver(1, 7, "north") + light(""), LANES);
        World world = World.start(scenario, Start.read(json("{'phases':{'tl':3}}")));
        assertEquals(Map.of("tl", 3), world.phases());
        assertEquals(List.of("red", "red_amber"), colours(world, 2));
    }

    @Test
    void aCycleOfOnesOwnKeepsItsOrder() {
        List<String> want = List.of("green", "green", "amber", "red", "green");
        assertEquals(want, colours(world(driver(1, 7, "north") + light(",'cycle':{'green':2,'amber':1,'red':1}"), LANES), 5));
        assertEquals(want, colours(world(driver(1, 7, "north") + light(",'cycle':[['green',2],['amber',1],['red',1]]"), LANES), 5));
    }

    @Test
    void insideTheCells() {
        World world = world(driver(1, 7, "north") + ",'goal':{'in':[[1,5],[2,5]]}", LANES);
        step(world, "forward(1)");
        assertFalse(world.finished());
        step(world, "forward(1)");
        assertTrue(world.finished());
        step(world, "forward(1)");
        assertTrue(world.finished(), "latched");
    }

    @Test
    void whoStartsAtTheGoalHasNotFinishedYet() {
        World world = world(driver(1, 7, "north") + ",'goal':{'in':[[1,7]]}", LANES);
        assertFalse(world.snapshot().finished());
        step(world, "wait");
        assertTrue(world.snapshot().finished());
    }

    @Test
    void whoCrashesAtTheGoalHasNotReachedItButWhoHasReachedItKeepsIt() {
        World crash = world(driver(1, 7, "north") + traffic(car("a", 1, 6, "north", 0)) + ",'goal':{'in':[[1,6]]}", LANES);
        step(crash, "forward(1)");
        assertTrue(crash.crashed("driver"));
        assertFalse(crash.finished());
        World later = world(driver(1, 7, "north") + traffic(car("a", 1, 5, "north", 0)) + ",'goal':{'in':[[1,6]]}", LANES);
        step(later, "forward(1)");
        step(later, "forward(1)");
        assertTrue(later.crashed("driver"));
        assertTrue(later.finished());
    }

    @Test
    void whoJumpsOverTheGoalHasNotFinished() {
        World world = world(driver(1, 7, "north") + ",'goal':{'in':[[1,6]]}", LANES);
        step(world, "forward(2)");
        assertFalse(world.finished());
    }

    @Test
    void beyondTheLightInTheDirectionOfItsTraffic() {
        World world = world(driver(1, 6, "north") + light("") + ",'goal':{'beyond':{'light':'tl','cells':2}}", LANES);
        step(world, "forward(1)");
        step(world, "forward(1)");
        assertFalse(world.finished());
        step(world, "forward(1)");
        assertTrue(world.finished());
        World around = world(driver(1, 7, "north") + ",'lights':[{'name':'tl','at':[0,1],'stop_line':[1,1],'faces':'south'}],'goal':{'beyond':{'light':'tl','cells':2}}", LANES);
        step(around, "wait");
        assertTrue(around.finished(), "wraps");
    }

    private static World overtaking(String drives, String goal, int lane) {
        return world(driver(lane, 7, "north") + traffic(car("slow", lane, 6, "north", 0)) + ",'drives':'" + drives + "','goal':{'overtaken':" + goal + "}", LANES);
    }

    @Test
    void overtakenOnTheOffside() {
        World world = overtaking("left", "{'car':'slow','within':3}", 1);
        step(world, "change_lane(right,2)");
        assertEquals("2,6,north,2", Worlds.at(world, "driver"));
        assertTrue(world.beside());
        step(world, "forward(1)");
        assertFalse(world.finished());
        step(world, "change_lane(left,2)");
        assertEquals("1,4,north,2", Worlds.at(world, "driver"));
        assertTrue(world.finished());
    }

    @Test
    void overtakenWhereTrafficDrivesOnTheRight() {
        World world = overtaking("right", "{'car':'slow','within':3}", 2);
        step(world, "change_lane(left,2)");
        assertTrue(world.beside());
        step(world, "forward(1)");
        step(world, "change_lane(right,2)");
        assertFalse(world.crashed("driver"));
        assertTrue(world.finished());
    }

    @Test
    void besideOnTheNearsideIsNotBeside() {
        World world = overtaking("right", "{'car':'slow','within':3}", 1);
        step(world, "change_lane(right,2)");
        assertFalse(world.beside());
        step(world, "forward(1)");
        step(world, "change_lane(left,2)");
        assertFalse(world.finished());
    }

    @Test
    void withoutHavingBeenBesideNothingIsOvertaken() {
        World world = overtaking("left", "{'car':'slow','within':3}", 1);
        step(world, "change_lane(right,4)");
        assertEquals("2,4,north,4", Worlds.at(world, "driver"));
        assertFalse(world.beside());
        step(world, "change_lane(left,1)");
        assertFalse(world.finished());
    }

    @Test
    void besideInAnotherHeadingIsNotBeside() {
        World world = world(driver(2, 7, "north") + traffic(car("slow", 1, 7, "south", 0)) + ",'goal':{'overtaken':{'car':'slow','within':3}}", LANES);
        step(world, "wait");
        assertFalse(world.beside());
    }

    @Test
    void tooFarAheadIsNotOvertakenButTheDistanceIsCountedAroundTheWorld() {
        World world = overtaking("left", "{'car':'slow','within':1}", 1);
        step(world, "change_lane(right,2)");
        step(world, "forward(1)");
        step(world, "change_lane(left,2)");
        assertEquals("1,4,north,2", Worlds.at(world, "driver"));
        assertFalse(world.finished());
        World around = world(driver(2, 1, "north") + traffic(car("slow", 1, 1, "north", 0)) + ",'goal':{'overtaken':{'car':'slow','within':3}}", LANES);
        step(around, "wait");
        assertTrue(around.beside());
        step(around, "forward(1)");
        step(around, "change_lane(left,2)");
        assertEquals("1,7,north,2", Worlds.at(around, "driver"));
        assertTrue(around.finished());
    }

    @Test
    void withoutAGoalNothingIsEverFinished() {
        World world = world(driver(1, 7, "north") + ",'goal':null", LANES);
        Worlds.times(50, i -> step(world, "forward(1)"));
        assertFalse(world.finished());
    }
}

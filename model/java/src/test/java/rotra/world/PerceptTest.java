package rotra.world;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertSame;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;
import static rotra.world.Worlds.car;
import static rotra.world.Worlds.driver;
import static rotra.world.Worlds.scenario;
import static rotra.world.Worlds.seen;
import static rotra.world.Worlds.step;
import static rotra.world.Worlds.traffic;
import static rotra.world.Worlds.world;

import java.util.ArrayList;
import java.util.Collections;
import java.util.List;
import java.util.Random;
import org.junit.jupiter.api.Test;

class PerceptTest {

    private static final String[] WIDE = new String[9];

    static {
        java.util.Arrays.fill(WIDE, "....^....");
    }

    private static String light(int x, int y, int stopX, int stopY, String faces) {
        return ",'lights':[{'name':'tl','at':[" + x + "," + y + "],'stop_line':[" + stopX + "," + stopY + "],'faces':'" + faces + "'}]";
    }

    @Test
    void aWholePerceptionIsSorted() {
        World world = world(driver(4, 4, "north") + light(3, 2, 4, 2, "south") + traffic(car("a", 4, 1, "north", 1), car("b", 4, 7, "north", 1)) + ",'radius':3", WIDE);
        assertEquals("[car(0,-3), car(0,3), drives(left), heading(north), light(-1,2,red), limit(3), road(0,-3,ahead), road(0,-2,ahead), "
                + "road(0,-1,ahead), road(0,0,ahead), road(0,1,ahead), road(0,2,ahead), road(0,3,ahead), speed(0), stop_line(0,2), task(straight_on)]",
                world.perceive("driver").toString());
        List<Percept> sorted = new ArrayList<>(world.perceive("driver"));
        Collections.sort(sorted);
        assertEquals(sorted, world.perceive("driver"));
    }

    @Test
    void orderIsFunctorThenArgumentsIntegersByValueAndFirst() {
        List<Percept> sorted = new ArrayList<>();
        for (String text : List.of("b(10)", "b(a)", "b(9)", "b(-3,z)", "b(-3,a)", "a(x)", "b", "b(-3)")) {
            sorted.add(Percept.parse(text));
        }
        Collections.sort(sorted);
        assertEquals("[a(x), b, b(-3), b(-3,a), b(-3,z), b(9), b(10), b(a)]", sorted.toString());
    }

    @Test
    void textIsReadAndShownWithoutSpaces() {
        Percept percept = Percept.parse(" light( -1 , 2 , red_amber ) ");
        assertEquals("light(-1,2,red_amber)", percept.toString());
        assertEquals(List.of(-1, 2, "red_amber"), percept.args());
        assertEquals(Percept.of("light", -1, 2, "red_amber"), percept);
        for (String bad : List.of("", "p(", "p()", "p(1,)", "(1)")) {
            assertThrows(IllegalArgumentException.class, () -> Percept.parse(bad), bad);
        }
    }

    @Test
    void theFrameIsTheDriversOwn() {
        String[] rows = {".........", ".........", ".........", ".........", "....>>...", ".........", ".........", ".........", "........."};
        String other = ",'traffic':[{'name':'a','at':[5,4],'heading':'east','speed':1}]";
        assertEquals(List.of("car(1,0)"), seen(world(driver(4, 4, "north") + other, rows), "car"));
        assertEquals(List.of("car(0,1)"), seen(world(driver(4, 4, "east") + other, rows), "car"));
        assertEquals(List.of("car(-1,0)"), seen(world(driver(4, 4, "south") + other, rows), "car"));
        assertEquals(List.of("car(0,-1)"), seen(world(driver(4, 4, "west") + other, rows), "car"));
        assertEquals(List.of("road(0,0,right)", "road(1,0,right)"), seen(world(driver(4, 4, "north"), rows), "road"));
        assertEquals(List.of("road(0,0,ahead)", "road(0,1,ahead)"), seen(world(driver(4, 4, "east"), rows), "road"));
        assertEquals(List.of("road(-1,0,left)", "road(0,0,left)"), seen(world(driver(4, 4, "south"), rows), "road"));
        assertEquals(List.of("road(0,-1,back)", "road(0,0,back)"), seen(world(driver(4, 4, "west"), rows), "road"));
    }

    @Test
    void aFreeCellHasAllFourFlows() {
        assertEquals(List.of("road(0,0,ahead)", "road(0,0,back)", "road(0,0,left)", "road(0,0,right)"),
                seen(world(driver(3, 3, "east") + ",'radius':1", ".......", ".......", ".......", "...+...", ".......", "......."), "road"));
    }

    @Test
    void theWindowWrapsAtEveryEdge() {
        World world = world(driver(4, 0, "north") + traffic(car("a", 4, 8, "north", 0)) + light(3, 7, 4, 7, "south"), WIDE);
        assertEquals(List.of("car(0,1)"), seen(world, "car"));
        assertEquals(List.of("light(-1,2,red)"), seen(world, "light"));
        assertEquals(List.of("stop_line(0,2)"), seen(world, "stop_line"));
        World sideways = world(driver(8, 4, "north") + traffic(car("a", 0, 4, "north", 0)), ".........", "+........", ".........", ".........", "+.......+");
        assertEquals(List.of("car(1,0)"), seen(sideways, "car"));
        assertEquals(7, seen(world, "road").size());
    }

    @Test
    void aNarrowWorldShowsAThingAtEachPlace() {
        World world = world(driver(1, 3, "north") + traffic(car("a", 1, 1, "north", 1)) + light(0, 2, 1, 2, "south"), ".^.", ".^.", ".^.", ".^.");
        assertEquals(List.of("car(-3,-2)", "car(-3,2)", "car(0,-2)", "car(0,2)", "car(3,-2)", "car(3,2)"), seen(world, "car"));
        assertEquals(List.of("light(-1,-3,red)", "light(-1,1,red)", "light(2,-3,red)", "light(2,1,red)"), seen(world, "light"));
        assertEquals(List.of("stop_line(-3,-3)", "stop_line(-3,1)", "stop_line(0,-3)", "stop_line(0,1)", "stop_line(3,-3)", "stop_line(3,1)"), seen(world, "stop_line"));
        assertEquals(21, seen(world, "road").size());
    }

    @Test
    void theOwnCarIsNeverPerceivedNotEvenAtItsImages() {
        assertEquals(List.of(), seen(world(driver(0, 0, "north"), "^", "^"), "car"));
    }

    @Test
    void aThingOutsideTheWindowIsNotPerceived() {
        World world = world(driver(4, 8, "north") + traffic(car("a", 4, 4, "north", 0)), WIDE);
        assertEquals(List.of(), seen(world, "car"));
    }

    @Test
    void onlyLightsThatFaceTheDriverAreSeenAndOnlyTheirStopLines() {
        for (String faces : List.of("north", "east", "south", "west")) {
            for (String heading : List.of("north", "east", "south", "west")) {
                World world = world(driver(4, 4, heading) + light(3, 4, 4, 4, faces), WIDE);
                boolean facing = Heading.of(faces).opposite() == Heading.of(heading);
                assertEquals(facing ? 1 : 0, seen(world, "light").size(), faces + " " + heading);
                assertEquals(facing ? 1 : 0, seen(world, "stop_line").size(), faces + " " + heading);
            }
        }
    }

    @Test
    void aStopLineIsSeenWithoutItsLight() {
        World world = world(driver(4, 4, "north") + light(0, 4, 4, 4, "south"), WIDE);
        assertEquals(List.of(), seen(world, "light"));
        assertEquals(List.of("stop_line(0,0)"), seen(world, "stop_line"));
    }

    @Test
    void theCellOfALightIsNoRoad() {
        Scenario scenario = scenario(driver(0, 0, "north") + light(1, 0, 0, 0, "south"), "^^..");
        assertFalse(scenario.isRoad(1, 0));
        assertEquals(List.of(), scenario.flows(1, 0));
        assertTrue(scenario.isRoad(0, 0));
    }

    @Test
    void speedIsTheLastStepsCells() {
        World world = world(driver(4, 8, "north"), WIDE);
        assertEquals(List.of("speed(0)"), seen(world, "speed"));
        step(world, "forward(2)");
        assertEquals(List.of("speed(2)"), seen(world, "speed"));
        step(world, "wait");
        assertEquals(List.of("speed(0)"), seen(world, "speed"));
    }

    @Test
    void aCrashedDriverPerceivesNothingAndACrashedCarIsAPercept() {
        World world = world(driver(0, 0, "north") + traffic("{'name':'a','at':[0,2],'heading':'east','speed':1}"), "^......", "^......", "^......", "^......", "^......", "^......", "^......");
        assertEquals(List.of("car(0,-2)"), seen(world, "car"));
        step(world, "wait");
        assertEquals("1,2,east,1!", Worlds.at(world, "a"));
        assertEquals(List.of("car(1,-2)"), seen(world, "car"));
        step(world, "turn(left,1)");
        assertTrue(world.crashed("driver"));
        assertEquals(List.of(), world.perceive("driver"));
    }

    @Test
    void twoCarsOnOneCellAreOnePercept() {
        World world = world(driver(0, 5, "north") + traffic("{'name':'a','at':[0,1],'heading':'east','speed':1}", "{'name':'b','at':[2,1],'heading':'west','speed':1}"),
                "^......", "+++....", "^......", "^......", "^......", "^......", "^......");
        step(world, "forward(1)");
        assertEquals(List.of("car(1,3)"), seen(world, "car"));
    }

    @Test
    void theSamePerceptIsTheSameObject() {
        World world = world(driver(4, 4, "north") + traffic(car("a", 4, 3, "north", 1)), WIDE);
        List<Percept> first = world.perceive("driver");
        List<Percept> again = world.copy().perceive("driver");
        for (int i = 0; i < first.size(); i++) {
            assertSame(first.get(i), again.get(i));
        }
    }

    @Test
    void inAnOpenScenarioTheCallerSaysWhatIsPerceivedAndActsHaveNoEffect() {
        World world = world(",'percepts':['b(2)','a(1)']");
        assertEquals(List.of(), world.perceive("driver"));
        world.setPercepts(List.of(Percept.parse("b(2)"), Percept.parse("a(1)"), Percept.parse("b(2)")));
        assertEquals("[a(1), b(2)]", world.perceive("driver").toString());
        assertTrue(step(world, "forward(1)"));
        assertEquals(List.of(), world.perceive("driver"));
        assertFalse(step(world, "fly"));
        assertEquals("{\"lights\":{},\"cars\":{},\"finished\":false}", world.snapshot().toJson().toString());
        World onRoad = world(driver(4, 4, "north"), WIDE);
        assertThrows(IllegalStateException.class, () -> onRoad.setPercepts(List.of()));
    }

    @Test
    void randomOpenPerceptsRespectExclusions() {
        World world = world(",'grid':'','percepts':['light(0,1,red)','light(0,1,green)','speed(0)','speed(1)','x'],"
                + "'percept_exclusions':[['light(0,1,red)','light(0,1,green)']]");
        Random random = new Random(7);
        java.util.Set<String> drawn = new java.util.HashSet<>();
        Worlds.times(500, i -> {
            world.choose(random);
            assertTrue(seen(world, "light").size() < 2);
            assertEquals(1, seen(world, "speed").size());
            drawn.add(world.perceive("driver").toString());
            step(world, "wait");
        });
        assertEquals(3 * 2 * 2, drawn.size());
    }
}

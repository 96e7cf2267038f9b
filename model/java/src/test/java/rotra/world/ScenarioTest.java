package rotra.world;

import static org.junit.jupiter.api.Assertions.assertArrayEquals;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;
import static rotra.world.Worlds.json;
import static rotra.world.Worlds.scenario;
import static rotra.world.Worlds.step;

import java.util.HashSet;
import java.util.List;
import java.util.Map;
import java.util.Random;
import java.util.Set;
import org.junit.jupiter.api.Test;

class ScenarioTest {

    private static final String VARIED = """
            {'id':'v','drives':'right','radius':2,'limit':1,'top_speed':2,'grid':'.^.\\n.^.\\n.^.\\n',
             'lights':[{'name':'tl','at':[0,1],'stop_line':[1,1],'faces':'south','phase':{'published':3,'all':'any'}}],
             'driver':{'at':{'published':[1,2],'all':[[1,2],[1,0]]},'heading':'north','task':'turn_left'},
             'traffic':[{'name':'a','at':{'published':[1,1],'all':[[1,1],[1,0]]},'heading':'north','speed':{'published':1,'all':[0,1]},'hesitates':{'published':false,'all':true}}],
             'goal':{'in':[[1,0]]}}""";

    @Test
    void everyFieldIsRead() {
        Scenario scenario = Scenario.read(json(VARIED));
        assertEquals("v", scenario.id());
        assertEquals(Side.RIGHT, scenario.drives());
        assertEquals(List.of(".^.", ".^.", ".^."), scenario.rows());
        assertEquals(3, scenario.width());
        assertEquals(2, scenario.topSpeed());
        assertEquals(10, scenario.lights().get(0).phase().all().size());
        assertEquals(List.of(false, true), scenario.traffic().get(0).hesitates().all());
        assertEquals(new Goal.InCells(List.of(new Cell(1, 0))), scenario.goal());
        assertFalse(scenario.isOpen());
        assertEquals(Set.of(), new HashSet<>(scenario.percepts()));
    }

    @Test
    void whatIsLeftOutHasItsDefault() {
        Scenario scenario = Scenario.read(json("{'limit':2,'rows':['^']}"));
        assertEquals(3, scenario.radius());
        assertEquals(3, scenario.topSpeed());
        assertEquals(Side.LEFT, scenario.drives());
        assertEquals(new Goal.None(), scenario.goal());
        assertTrue(Scenario.read(json("{'id':'open'}")).isOpen());
    }

    @Test
    void rowsOfDifferentLengthAreRefused() {
        assertThrows(IllegalArgumentException.class, () -> scenario("", "^^", "^"));
    }

    @Test
    void thePublishedStart() {
        Start start = Start.published(Scenario.read(json(VARIED)));
        assertArrayEquals(new int[] {1, 2}, start.driverAt());
        assertEquals(Map.of("tl", 3), start.phases());
        assertArrayEquals(new int[] {1, 1}, start.trafficAt().get("a"));
        assertEquals(Map.of("a", 1), start.trafficSpeed());
    }

    @Test
    void randomStartsAreAllThoseWhereEveryCarHasItsOwnCell() {
        Scenario scenario = Scenario.read(json(VARIED));
        Random random = new Random(3);
        Set<String> places = new HashSet<>();
        Set<Integer> phases = new HashSet<>();
        for (int i = 0; i < 300; i++) {
            World world = World.start(scenario, Start.random(scenario, random));
            Map<String, WorldState.Car> cars = world.snapshot().cars();
            places.add(cars.get("driver").y() + " " + cars.get("a").y());
            phases.add(world.phases().get("tl"));
        }
        assertEquals(Set.of("2 1", "2 0", "0 1"), places);
        assertEquals(10, phases.size());
    }

    @Test
    void aSeedGivesOneRun() {
        assertEquals(run(5), run(5));
        assertFalse(run(5).equals(run(6)));
    }

    private static String run(int seed) {
        Scenario scenario = Scenario.read(json(VARIED));
        Random random = new Random(seed);
        World world = World.start(scenario, Start.random(scenario, random));
        StringBuilder out = new StringBuilder();
        for (int i = 0; i < 20; i++) {
            world.choose(random);
            out.append(world.hesitating()).append(world.key()).append('\n');
            step(world, "wait");
        }
        return out.toString();
    }

    @Test
    void aStartThatIsReadMayLeaveThingsOut() {
        Scenario scenario = Scenario.read(json(VARIED));
        World world = World.start(scenario, Start.read(json("{'driverAt':[1,0],'phases':{},'trafficAt':{'a':[1,2]},'trafficSpeed':{'a':0}}")));
        step(world, "wait");
        assertEquals("1,0,north,0", Worlds.at(world, "driver"));
        assertEquals("1,2,north,0", Worlds.at(world, "a"));
        assertEquals("1,2,north,0", Worlds.at(World.start(scenario, Start.read(json("{'driverAt':null}"))), "driver"));
    }

    @Test
    void aStartOffTheRoadOrOnOneCellIsRefused() {
        Scenario scenario = Scenario.read(json(VARIED));
        for (String start : List.of("{'driverAt':[0,0]}", "{'driverAt':[1,3]}", "{'driverAt':[1,1]}", "{'trafficAt':{'a':[2,0]}}")) {
            assertThrows(IllegalArgumentException.class, () -> World.start(scenario, Start.read(json(start))), start);
        }
    }

    @Test
    void theSnapshotIsTheTracesJson() {
        World world = Worlds.world(Scenario.read(json(VARIED)));
        assertEquals("{'lights':{'tl':'red'},'cars':{'driver':{'x':1,'y':2,'heading':'north','speed':0,'crashed':false},"
                + "'a':{'x':1,'y':1,'heading':'north','speed':0,'crashed':false}},'finished':false}", world.snapshot().toJson().toString().replace('"', '\''));
    }

    @Test
    void aWorldAsText() {
        World world = Worlds.world(Scenario.read(json(VARIED)));
        assertEquals("tl red   driver 1,2 north 0   a 1,1 north 0\n .  ^  .\n R  c_ .\n .  D  .\n", Render.text(world));
        world.setHesitating(Set.of("a"));
        assertTrue(Render.text(world).contains("hesitating: a\n"));
        step(world, "forward(1)");
        assertTrue(Render.text(world).contains(" r  X_ ."), Render.text(world));
    }
}

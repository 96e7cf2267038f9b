package rotra.world;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertFalse;
import static org.junit.jupiter.api.Assertions.assertNull;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;
import static rotra.world.Worlds.at;
import static rotra.world.Worlds.car;
import static rotra.world.Worlds.driver;
import static rotra.world.Worlds.step;
import static rotra.world.Worlds.traffic;
import static rotra.world.Worlds.world;

import java.util.List;
import java.util.Map;
import java.util.Set;
import org.junit.jupiter.api.Test;

class MovesTest {

    private static final String[] FREE = {"+++++++", "+++++++", "+++++++", "+++++++", "+++++++", "+++++++", "+++++++"};
    private static final String[] RING = {"^.", "^.", "^.", "^."};

    /** A world whose driver is out of the way, in the column furthest right. */
    private static World aside(String... cars) {
        return world(driver(6, 6, "north") + traffic(cars), FREE);
    }

    // -- acts -----------------------------------------------------------------------------------------------------------

    @Test
    void forwardGoesAheadInEveryHeadingAndWraps() {
        for (String[] want : List.of(new String[] {"north", "3,1,north,2"}, new String[] {"south", "3,5,south,2"},
                new String[] {"east", "5,3,east,2"}, new String[] {"west", "1,3,west,2"})) {
            World world = world(driver(3, 3, want[0]), FREE);
            assertTrue(step(world, "forward(2)"));
            assertEquals(want[1], at(world, "driver"));
        }
        World world = world(driver(0, 0, "north"), FREE);
        step(world, "forward(3)");
        assertEquals("0,4,north,3", at(world, "driver"));
        world = world(driver(0, 0, "west"), FREE);
        step(world, "forward(1)");
        assertEquals("6,0,west,1", at(world, "driver"));
    }

    @Test
    void changingLaneGoesSidewaysOnceThenAheadAndKeepsTheHeading() {
        World world = world(driver(3, 5, "north"), FREE);
        step(world, "change_lane(right,3)");
        assertEquals("4,3,north,3", at(world, "driver"));
        step(world, "change_lane(left,1)");
        assertEquals("3,3,north,1", at(world, "driver"));
        World east = world(driver(3, 3, "east"), FREE);
        step(east, "change_lane(right,2)");
        assertEquals("4,4,east,2", at(east, "driver"));
    }

    @Test
    void turningTakesTheSideAsHeading() {
        World world = world(driver(3, 3, "north"), FREE);
        step(world, "turn(right,2)");
        assertEquals("5,3,east,2", at(world, "driver"));
        step(world, "turn(left,1)");
        assertEquals("5,2,north,1", at(world, "driver"));
        step(world, "turn(left,3)");
        assertEquals("2,2,west,3", at(world, "driver"));
        step(world, "turn(left,1)");
        assertEquals("2,3,south,1", at(world, "driver"));
    }

    @Test
    void waitingStandsStill() {
        World world = world(driver(3, 3, "north"), FREE);
        step(world, "forward(1)");
        assertTrue(step(world, "wait"));
        assertEquals("3,2,north,0", at(world, "driver"));
        assertTrue(world.step(Map.of()).get("driver"), "no act is wait");
        assertEquals("3,2,north,0", at(world, "driver"));
    }

    @Test
    void whatIsNoActIsWait() {
        for (String act : List.of("forward(0)", "forward(5)", "forward(-1)", "forward", "forward(1,2)", "forward(x)", "fly(1)", "wait(1)",
                "change_lane(up,1)", "change_lane(left,0)", "change_lane(left,5)", "change_lane(left)", "turn(right,9)", "turn(1,right)")) {
            World world = world(driver(3, 3, "north"), FREE);
            assertFalse(step(world, act), act);
            assertEquals(Map.of("driver", "no_such_act"), world.faults(), act);
            assertEquals("3,3,north,0", at(world, "driver"), act);
        }
    }

    @Test
    void theTopSpeedIsOneOverTheLimitUnlessTheScenarioSaysOtherwise() {
        assertTrue(step(world(driver(3, 3, "north"), FREE), "forward(4)"));
        assertTrue(step(world(driver(3, 3, "north") + ",'top_speed':6", FREE), "forward(6)"));
        assertFalse(step(world(driver(3, 3, "north") + ",'top_speed':3", FREE), "forward(4)"));
    }

    @Test
    void everyActThereIsCanBeDone() {
        assertEquals(1 + 5 * 4, Act.all(4).size());
        for (Act act : Act.all(4)) {
            World world = world(driver(3, 3, "north"), FREE);
            assertEquals(Map.of("driver", true), world.step(Map.of("driver", act)), act.toString());
            assertEquals(act, Act.parse(act.toString()));
        }
        assertEquals(Act.parse("turn(left,2)"), Act.of("turn", List.of("left", 2)));
        assertEquals(Act.parse("turn(left,2)"), Act.of("turn", "left", 2));
    }

    // -- crashes --------------------------------------------------------------------------------------------------------

    @Test
    void offTheRoadTheFurtherMovesAreVoid() {
        World world = world(driver(1, 3, "north"), ".^..", "....", ".^..", ".^..");
        assertFalse(step(world, "forward(4)"));
        assertEquals(Map.of("driver", "crashed"), world.faults());
        assertEquals("1,1,north,2!", at(world, "driver"));
        assertFalse(step(world, "forward(1)"), "a crashed car does nothing");
        assertEquals("1,1,north,0!", at(world, "driver"));
    }

    @Test
    void aTurnOffTheRoadHasTurned() {
        World world = world(driver(1, 3, "north"), ".^..", ".^..", ".^..", ".^..");
        step(world, "turn(right,2)");
        assertEquals("2,3,east,1!", at(world, "driver"));
        World lane = world(driver(1, 3, "north"), ".^..", ".^..", ".^..", ".^..");
        step(lane, "change_lane(right,2)");
        assertEquals("2,3,north,1!", at(lane, "driver"));
    }

    @Test
    void aTurnDoesNotTurnACarThatHasCrashed() {
        World world = world(driver(1, 3, "north"), ".^..", ".^..", ".^..", ".^..");
        step(world, "change_lane(right,1)");
        step(world, "turn(right,1)");
        assertEquals("2,3,north,0!", at(world, "driver"));
    }

    @Test
    void aStandingCarIsHitByTheOneThatComes() {
        World world = world(driver(3, 4, "north") + traffic(car("a", 3, 3, "north", 1)), FREE);
        step(world, "forward(2)", "a");
        assertEquals("3,3,north,1!", at(world, "driver"));
        assertEquals("3,3,north,0!", at(world, "a"));
    }

    @Test
    void aCollisionInASubStepCountsThoughBothWouldHavePassed() {
        // the driver crosses a's way; both are on (3,3) after the first cell
        World world = world(driver(3, 4, "north") + traffic(car("a", 2, 3, "east", 2)), FREE);
        step(world, "forward(2)");
        assertEquals("3,3,north,1!", at(world, "driver"));
        assertEquals("3,3,east,1!", at(world, "a"));
    }

    @Test
    void crossingOneSubStepLaterIsNoCollision() {
        World world = world(driver(3, 4, "north") + traffic(car("a", 1, 3, "east", 2)), FREE);
        step(world, "forward(2)");
        assertEquals("3,2,north,2", at(world, "driver"));
        assertEquals("3,3,east,2", at(world, "a"));
    }

    @Test
    void theLaterSubStepsCanCollideWithACarThatHasEndedItsMoves() {
        World world = world(driver(3, 5, "north") + traffic(car("a", 3, 4, "north", 1)), FREE);
        step(world, "forward(3)");
        assertEquals("3,3,north,2!", at(world, "driver"));
        assertEquals("3,3,north,1!", at(world, "a"));
    }

    @Test
    void swappingCellsIsACrashAndEachIsBackOnItsOldCell() {
        World world = world(driver(3, 4, "north") + traffic(car("a", 3, 3, "south", 1)), FREE);
        step(world, "forward(2)");
        assertEquals("3,4,north,0!", at(world, "driver"));
        assertEquals("3,3,south,0!", at(world, "a"));
    }

    @Test
    void oneWhoEntersTheCellOfASwapHasCrashedToo() {
        World world = world(driver(3, 3, "north") + traffic(car("a", 3, 2, "south", 1), car("b", 2, 3, "east", 1)), FREE);
        step(world, "forward(1)");
        assertEquals("3,3,north,0!", at(world, "driver"));
        assertEquals("3,2,south,0!", at(world, "a"));
        assertEquals("3,3,east,1!", at(world, "b"));
    }

    @Test
    void swappingByChangingLaneAndByTurningIsASwap() {
        World lane = world(driver(2, 3, "north") + traffic(car("a", 3, 3, "west", 1)), FREE);
        step(lane, "change_lane(right,1)");
        assertEquals("2,3,north,0!", at(lane, "driver"));
        World turn = world(driver(2, 3, "north") + traffic(car("a", 3, 3, "west", 1)), FREE);
        step(turn, "turn(right,1)");
        assertEquals("2,3,east,0!", at(turn, "driver"));
    }

    @Test
    void threeCarsOnOneCellHaveAllCrashed() {
        World world = world(driver(3, 4, "north") + traffic(car("a", 2, 3, "east", 1), car("b", 4, 3, "west", 1)), FREE);
        step(world, "forward(1)");
        for (String name : List.of("driver", "a", "b")) {
            assertTrue(at(world, name).startsWith("3,3,") && at(world, name).endsWith("!"), name);
        }
    }

    @Test
    void aCrashedCarStaysAnObstacle() {
        World world = world(driver(3, 5, "north") + traffic(car("a", 2, 1, "west", 1)), "+++++++", "..+++++", "+++++++", "+++++++", "+++++++", "+++++++", "+++++++");
        step(world, "forward(1)");
        assertEquals("1,1,west,1!", at(world, "a"));
        step(world, "turn(left,2)");
        assertEquals("1,4,west,2", at(world, "driver"));
        step(world, "turn(right,3)");
        assertEquals("1,1,north,3!", at(world, "driver"));
    }

    // -- scripted cars --------------------------------------------------------------------------------------------------

    @Test
    void trafficGoesItsSpeedAndStandsWhenItHesitates() {
        World world = aside(car("a", 1, 6, "north", 2));
        step(world, "wait");
        assertEquals("1,4,north,2", at(world, "a"));
        step(world, "wait", "a");
        assertEquals("1,4,north,0", at(world, "a"));
        step(world, "wait");
        assertEquals("1,2,north,2", at(world, "a"));
        step(world, "wait");
        step(world, "wait");
        assertEquals("1,5,north,2", at(world, "a"), "it wraps");
    }

    @Test
    void trafficWaitsBehindAStandingDriver() {
        World world = world(driver(3, 3, "north") + traffic(car("a", 3, 5, "north", 2)), FREE);
        step(world, "wait");
        assertEquals("3,4,north,1", at(world, "a"));
        step(world, "wait");
        assertEquals("3,4,north,0", at(world, "a"));
        assertEquals("3,3,north,0", at(world, "driver"));
    }

    @Test
    void trafficFollowsADriverWhoMoves() {
        World world = world(driver(3, 3, "north") + traffic(car("a", 3, 4, "north", 2)), FREE);
        step(world, "forward(1)");
        assertEquals("3,3,north,1", at(world, "a"), "its second cell is taken by one who has stopped");
        assertEquals("3,2,north,1", at(world, "driver"));
    }

    @Test
    void trafficEntersTheCellADriverLeavesSideways() {
        World world = world(driver(3, 3, "north") + traffic(car("a", 3, 4, "north", 1)), FREE);
        step(world, "change_lane(right,1)");
        assertEquals("3,3,north,1", at(world, "a"));
        assertEquals("4,3,north,1", at(world, "driver"));
    }

    @Test
    void trafficDoesNotWaitForOneWhoMovesIntoItsWay() {
        World crossing = world(driver(1, 3, "east") + traffic(car("b", 2, 4, "north", 3)), FREE);
        step(crossing, "forward(1)");
        assertEquals("2,3,east,1!", at(crossing, "driver"));
        assertEquals("2,3,north,1!", at(crossing, "b"));
        World among = aside(car("b", 2, 4, "north", 3), car("c", 3, 3, "west", 1));
        step(among, "wait");
        assertEquals("2,3,west,1!", at(among, "c"));
        assertEquals("2,3,north,1!", at(among, "b"));
    }

    @Test
    void trafficGoesAsFarAsItsWayIsFreeSubStepBySubStep() {
        World world = aside(car("c", 4, 3, "north", 1), car("slow", 3, 3, "east", 2), car("fast", 2, 3, "east", 3));
        step(world, "wait");
        assertEquals("4,2,north,1", at(world, "c"));
        assertEquals("5,3,east,2", at(world, "slow"), "c leaves its cell as slow enters it");
        assertEquals("4,3,east,2", at(world, "fast"), "slow has no third move");
    }

    @Test
    void trafficWaitsForADriverStandingAcrossItsWay() {
        World held = world(driver(4, 3, "north") + traffic(car("a", 3, 3, "east", 2), car("b", 2, 3, "east", 1)), FREE);
        step(held, "wait");
        assertEquals("3,3,east,0", at(held, "a"));
        assertEquals("2,3,east,0", at(held, "b"));
    }

    @Test
    void aChainMovesAsOneAndStandsAsOne() {
        World moving = aside(car("a", 1, 4, "north", 1), car("b", 1, 3, "north", 1), car("c", 1, 2, "north", 1));
        step(moving, "wait");
        assertEquals("1,3,north,1 1,2,north,1 1,1,north,1", at(moving, "a") + " " + at(moving, "b") + " " + at(moving, "c"));
        step(moving, "wait", "c");
        assertEquals("1,3,north,0 1,2,north,0 1,1,north,0", at(moving, "a") + " " + at(moving, "b") + " " + at(moving, "c"));
        step(moving, "wait", "b");
        assertEquals("1,3,north,0 1,2,north,0 1,0,north,1", at(moving, "a") + " " + at(moving, "b") + " " + at(moving, "c"));
    }

    @Test
    void aFullRingGoesAround() {
        World world = world(driver(0, 0, "north") + traffic(car("a", 0, 1, "north", 1), car("b", 0, 2, "north", 1), car("c", 0, 3, "north", 1)), RING);
        step(world, "forward(1)");
        assertEquals("0,3,north,1", at(world, "driver"));
        assertEquals("0,0,north,1", at(world, "a"));
        step(world, "wait");
        assertEquals("0,3,north,0", at(world, "driver"));
        assertEquals("0,0,north,0", at(world, "a"), "one stands, so all do");
        assertEquals("0,1,north,0", at(world, "b"));
    }

    @Test
    void exchangingCellsInARingOfTwoIsASwap() {
        World world = world(driver(0, 0, "north") + traffic(car("a", 0, 1, "north", 1)), "^", "^");
        step(world, "forward(1)");
        assertEquals("0,0,north,0!", at(world, "driver"));
        assertEquals("0,1,north,0!", at(world, "a"));
    }

    @Test
    void trafficWaitsBehindACrash() {
        World world = world(driver(3, 2, "north") + traffic(car("a", 3, 5, "north", 1)), "+++++++", ".......", "+++++++", "+++++++", "+++++++", "+++++++", "+++++++");
        step(world, "forward(1)");
        assertEquals("3,1,north,1!", at(world, "driver"));
        step(world, "wait");
        step(world, "wait");
        step(world, "wait");
        assertEquals("3,2,north,0", at(world, "a"));
    }

    @Test
    void trafficMayEndOffTheRoad() {
        World world = world(driver(6, 6, "north") + traffic(car("a", 1, 1, "north", 2)), ".......", "+++++++", "+++++++", "+++++++", "+++++++", "+++++++", "+++++++");
        step(world, "wait");
        assertEquals("1,0,north,1!", at(world, "a"));
    }

    @Test
    void hesitatingIsForOneStepAndOnlyForThoseWhoMay() {
        World world = aside(car("a", 1, 4, "north", 1), "{'name':'b','at':[2,4],'heading':'north','speed':1}");
        assertEquals(List.of("a"), world.mayHesitate());
        world.setHesitating(Set.of("a"));
        assertEquals(List.of("a"), world.hesitating());
        step(world, "wait");
        assertEquals(List.of(), world.hesitating());
        assertThrows(IllegalArgumentException.class, () -> world.setHesitating(Set.of("b")));
        assertThrows(IllegalArgumentException.class, () -> world.setHesitating(Set.of("nobody")));
    }

    @Test
    void noTrafficIsAtFaultAmongItself() {
        // many cars in one lane, every choice of who hesitates: nobody ever crashes
        java.util.Random random = new java.util.Random(1);
        World world = aside(car("a", 1, 6, "north", 3), car("b", 1, 4, "north", 1), car("c", 1, 3, "north", 2), car("d", 1, 1, "north", 3));
        Worlds.times(2000, i -> {
            world.choose(random);
            step(world, "wait");
            assertTrue(world.snapshot().cars().values().stream().noneMatch(WorldState.Car::crashed));
        });
    }

    @Test
    void aCopyGoesItsOwnWay() {
        World world = world(driver(3, 3, "north"), FREE);
        World copy = world.copy();
        assertEquals(world.key(), copy.key());
        step(copy, "forward(1)");
        assertEquals("3,3,north,0", at(world, "driver"));
        assertEquals("3,2,north,1", at(copy, "driver"));
        assertFalse(world.key().equals(copy.key()));
        assertNull(world.faults().get("driver"));
    }
}

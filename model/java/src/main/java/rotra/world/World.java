package rotra.world;

import java.util.ArrayList;
import java.util.Arrays;
import java.util.Collection;
import java.util.LinkedHashMap;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;
import java.util.Random;
import java.util.Set;

/**
 * The grid world, one step at a time, exactly as model/README.md states it.
 *
 * <p>In: a scenario, its start, each step's choices (who hesitates; in an open scenario what is perceived) and acts.  Out:
 * percepts, what became of the acts, snapshots.  Left to others: who drives (agents/java), how it looks (Render).
 *
 * <pre>
 *     World world = World.start(scenario, Start.published(scenario));
 *     world.setHesitating(Set.of("slow"));                            // first of all: it is part of the state shown
 *     List&lt;Percept&gt; seen = world.perceive("driver");
 *     Map&lt;String, Boolean&gt; done = world.step(Map.of("driver", Act.parse("forward(1)")));
 * </pre>
 *
 * Mutable and for one thread; {@link #copy} branches it.
 */
public final class World {

    /** Why an act was not done. */
    public static final String NO_SUCH_ACT = "no_such_act";
    public static final String CRASHED = "crashed";

    private static final int DRIVER = 0;

    private final Scenario scenario;
    private final Window window;
    private final Goal goal;
    private final int overtaken;
    private final Cell beyond;
    private final int width;
    private final int height;
    private final boolean[] road;
    private final String[] names;

    private final int[] x;
    private final int[] y;
    private final Heading[] heading;
    private final int[] moved;
    private final boolean[] crashed;
    private final int[] speed;
    private final int[] phase;
    private final Set<String> hesitating = new LinkedHashSet<>();
    private List<Percept> given = List.of();
    private boolean beside;
    private boolean finished;
    private int steps;
    private Map<String, String> faults = Map.of();

    private World(Scenario scenario, Start start) {
        this.scenario = scenario;
        width = scenario.width();
        height = scenario.height();
        goal = scenario.goal();
        int cars = scenario.isOpen() ? 0 : 1 + scenario.traffic().size();
        names = new String[cars];
        x = new int[cars];
        y = new int[cars];
        heading = new Heading[cars];
        moved = new int[cars];
        crashed = new boolean[cars];
        speed = new int[cars];
        phase = new int[scenario.lights().size()];
        road = new boolean[width * height];
        window = scenario.isOpen() ? null : new Window(scenario);
        if (!scenario.isOpen()) {
            for (int i = 0; i < road.length; i++) {
                road[i] = scenario.isRoad(i % width, i / width);
            }
            place(start);
        }
        for (int i = 0; i < phase.length; i++) {
            Scenario.Light light = scenario.lights().get(i);
            phase[i] = Math.floorMod(start.phases().getOrDefault(light.name(), light.phase().published()), light.period());
        }
        overtaken = goal instanceof Goal.Overtaken g ? index(g.car()) : -1;
        beyond = goal instanceof Goal.Beyond g ? beyond(scenario.light(g.light()), g.cells()) : null;
    }

    private World(World other) {
        scenario = other.scenario;
        window = other.window;
        goal = other.goal;
        overtaken = other.overtaken;
        beyond = other.beyond;
        width = other.width;
        height = other.height;
        road = other.road;
        names = other.names;
        x = other.x.clone();
        y = other.y.clone();
        heading = other.heading.clone();
        moved = other.moved.clone();
        crashed = other.crashed.clone();
        speed = other.speed;
        phase = other.phase.clone();
        hesitating.addAll(other.hesitating);
        given = other.given;
        beside = other.beside;
        finished = other.finished;
        steps = other.steps;
        faults = other.faults;
    }

    /** The world as it is shown in step 1. */
    public static World start(Scenario scenario, Start start) {
        return new World(scenario, start);
    }

    /** Another world in the same state; what never changes is shared. */
    public World copy() {
        return new World(this);
    }

    private void place(Start start) {
        Scenario.Driver driver = scenario.driver();
        Cell at = driver.at().published();
        names[DRIVER] = driver.name();
        heading[DRIVER] = driver.heading();
        put(DRIVER, start.driverAt() == null ? new int[] {at.x(), at.y()} : start.driverAt());
        for (int i = 1; i < names.length; i++) {
            Scenario.ScriptedCar car = scenario.traffic().get(i - 1);
            Cell published = car.at().published();
            names[i] = car.name();
            heading[i] = car.heading();
            speed[i] = start.trafficSpeed().getOrDefault(car.name(), car.speed().published());
            put(i, start.trafficAt().getOrDefault(car.name(), new int[] {published.x(), published.y()}));
        }
    }

    private void put(int car, int[] at) {
        if (at[0] < 0 || at[0] >= width || at[1] < 0 || at[1] >= height || !road[at[1] * width + at[0]]) {
            throw new IllegalArgumentException("car " + names[car] + " starts off the road, at [" + at[0] + ", " + at[1] + "]");
        }
        x[car] = at[0];
        y[car] = at[1];
        for (int other = 0; other < car; other++) {
            if (x[other] == x[car] && y[other] == y[car]) {
                throw new IllegalArgumentException("cars " + names[other] + " and " + names[car] + " start on one cell, [" + at[0] + ", " + at[1] + "]");
            }
        }
    }

    private Cell beyond(Scenario.Light light, int cells) {
        return light.stopLine().ahead(light.faces().opposite(), cells, width, height);
    }

    private int index(String name) {
        for (int i = 0; i < names.length; i++) {
            if (names[i].equals(name)) {
                return i;
            }
        }
        throw new IllegalArgumentException("scenario " + scenario.id() + " has no car " + name);
    }

    // -- what the world chooses -----------------------------------------------------------------------------------------

    /** The scripted cars that may hesitate, in the scenario's order. */
    public List<String> mayHesitate() {
        return scenario.traffic().stream().filter(car -> car.hesitates().all().contains(true)).map(Scenario.ScriptedCar::name).toList();
    }

    /** Who hesitates in the step at hand; chosen before anything is perceived, forgotten when the step is done. */
    public void setHesitating(Set<String> names) {
        List<String> may = mayHesitate();
        for (String name : names) {
            if (!may.contains(name)) {
                throw new IllegalArgumentException("car " + name + " does not hesitate in scenario " + scenario.id());
            }
        }
        hesitating.clear();
        may.stream().filter(names::contains).forEach(hesitating::add);
    }

    /** Those who hesitate in this step, in the scenario's order. */
    public List<String> hesitating() {
        return List.copyOf(hesitating);
    }

    /** Every choice of this step drawn evenly: who hesitates, and in an open scenario what is perceived. */
    public void choose(Random random) {
        Set<String> chosen = new LinkedHashSet<>();
        for (String name : mayHesitate()) {
            if (random.nextBoolean()) {
                chosen.add(name);
            }
        }
        setHesitating(chosen);
        if (scenario.isOpen()) {
            setPercepts(OpenPercepts.draw(scenario, random));
        }
    }

    /** In an open scenario: all that is perceived in this step, in any order. */
    public void setPercepts(Collection<Percept> percepts) {
        if (!scenario.isOpen()) {
            throw new IllegalStateException("only an open scenario is told what is perceived");
        }
        given = percepts.stream().sorted().distinct().toList();
    }

    // -- what is perceived ----------------------------------------------------------------------------------------------

    /** All that the driver senses now, sorted; nothing once it has crashed. */
    public List<Percept> perceive(String driver) {
        if (scenario.isOpen()) {
            return given;
        }
        int own = index(driver);
        if (crashed[own]) {
            return List.of();
        }
        Heading towards = heading[own];
        List<Percept> roads = window.roads(x[own], y[own], towards);
        List<Percept> stopLines = window.stopLines(x[own], y[own], towards);
        List<Percept> seen = new ArrayList<>(roads.size() + stopLines.size() + 16);
        for (int car = 0; car < names.length; car++) {
            if (car != own) {
                seen.addAll(window.car(x[car] - x[own], y[car] - y[own], towards));
            }
        }
        order(seen, 0);
        seen.add(window.drives);
        seen.add(window.heading(towards));
        int lights = seen.size();
        for (int i = 0; i < phase.length; i++) {
            Scenario.Light light = scenario.lights().get(i);
            if (Window.faces(light, towards)) {
                seen.addAll(window.light(light.at().x() - x[own], light.at().y() - y[own], towards, light.colour(phase[i])));
            }
        }
        order(seen, lights);
        seen.add(window.limit);
        seen.addAll(roads);
        seen.add(window.speed(moved[own]));
        seen.addAll(stopLines);
        seen.add(window.task);
        return seen;
    }

    /** Sorts the end of the list and leaves one of each. */
    private static void order(List<Percept> seen, int from) {
        List<Percept> end = seen.subList(from, seen.size());
        if (end.size() < 2) {
            return;
        }
        end.sort(null);
        for (int i = end.size() - 1; i > 0; i--) {
            if (end.get(i).equals(end.get(i - 1))) {
                end.remove(i);
            }
        }
    }

    // -- one step -------------------------------------------------------------------------------------------------------

    /** All act at once, everybody moves, the goal is tested, the lights advance.  Was each driver's act done?  No act is `wait`. */
    public Map<String, Boolean> step(Map<String, Act> acts) {
        String driver = scenario.driver().name();
        Act act = acts.getOrDefault(driver, Act.WAIT);
        Act.Move move = act.move(scenario.topSpeed());
        String fault = move == null ? NO_SUCH_ACT : null;
        if (!scenario.isOpen()) {
            moveAll(move == null ? Act.Move.NONE : move);
            testGoal();
            if (fault == null && crashed[DRIVER]) {
                fault = CRASHED;
            }
        }
        for (int i = 0; i < phase.length; i++) {
            phase[i] = (phase[i] + 1) % scenario.lights().get(i).period();
        }
        hesitating.clear();
        given = List.of();
        steps++;
        faults = fault == null ? Map.of() : Map.of(driver, fault);
        return Map.of(driver, fault == null);
    }

    /** Of the last step: per driver whose act was not done, the reason. */
    public Map<String, String> faults() {
        return faults;
    }

    private void moveAll(Act.Move act) {
        int cars = names.length;
        int[] moves = new int[cars];
        moves[DRIVER] = act.cells();
        for (int i = 1; i < cars; i++) {
            moves[i] = hesitating.contains(names[i]) ? 0 : speed[i];
        }
        Arrays.fill(moved, 0);
        int last = Arrays.stream(moves).max().orElse(0);
        for (int k = 1; k <= last; k++) {
            Heading[] way = heading.clone();
            if (k == 1 && act.side() != null && !crashed[DRIVER]) {
                way[DRIVER] = heading[DRIVER].to(act.side());
                if (act.turns()) {
                    heading[DRIVER] = way[DRIVER];
                }
            }
            subStep(way, movers(moves, k));
        }
    }

    /** Who moves in sub-step k: the most cars such that no scripted one enters the cell of a car that stays. */
    private boolean[] movers(int[] moves, int k) {
        int cars = names.length;
        boolean[] moving = new boolean[cars];
        for (int i = 0; i < cars; i++) {
            moving[i] = !crashed[i] && k <= moves[i];
        }
        boolean changed = true;
        while (changed) {
            changed = false;
            for (int i = 1; i < cars; i++) {
                if (moving[i] && standsAt(Math.floorMod(x[i] + heading[i].dx, width), Math.floorMod(y[i] + heading[i].dy, height), moving)) {
                    moving[i] = false;
                    changed = true;
                }
            }
        }
        return moving;
    }

    private boolean standsAt(int cellX, int cellY, boolean[] moving) {
        for (int i = 0; i < names.length; i++) {
            if (!moving[i] && x[i] == cellX && y[i] == cellY) {
                return true;
            }
        }
        return false;
    }

    /** One cell each; then swaps, then shared cells, then the edge of the road. */
    private void subStep(Heading[] way, boolean[] moving) {
        int cars = names.length;
        int[] oldX = x.clone();
        int[] oldY = y.clone();
        for (int i = 0; i < cars; i++) {
            if (moving[i]) {
                x[i] = Math.floorMod(x[i] + way[i].dx, width);
                y[i] = Math.floorMod(y[i] + way[i].dy, height);
                moved[i]++;
            }
        }
        boolean[] back = new boolean[cars];
        for (int i = 0; i < cars; i++) {
            for (int j = i + 1; j < cars; j++) {
                if (moving[i] && moving[j] && x[i] == oldX[j] && y[i] == oldY[j] && x[j] == oldX[i] && y[j] == oldY[i]) {
                    back[i] = true;
                    back[j] = true;
                }
            }
        }
        for (int i = 0; i < cars; i++) {
            if (back[i]) {
                x[i] = oldX[i];
                y[i] = oldY[i];
                moved[i]--;
                crashed[i] = true;
            }
        }
        for (int i = 0; i < cars; i++) {
            for (int j = i + 1; j < cars; j++) {
                if (x[i] == x[j] && y[i] == y[j]) {
                    crashed[i] = true;
                    crashed[j] = true;
                }
            }
            if (!road[y[i] * width + x[i]]) {
                crashed[i] = true;
            }
        }
    }

    /** A driver that has crashed reaches nothing any more. */
    private void testGoal() {
        if (crashed[DRIVER]) {
            return;
        }
        Cell at = new Cell(x[DRIVER], y[DRIVER]);
        boolean reached;
        if (goal instanceof Goal.InCells in) {
            reached = in.cells().contains(at);
        } else if (goal instanceof Goal.Beyond) {
            reached = at.equals(beyond);
        } else if (goal instanceof Goal.Overtaken past) {
            Cell car = new Cell(x[overtaken], y[overtaken]);
            Heading lane = heading[overtaken];
            boolean ahead = false;
            for (int d = 1; d <= past.within(); d++) {
                ahead |= car.ahead(lane, d, width, height).equals(at);
            }
            reached = beside && ahead;
            beside |= heading[DRIVER] == lane && car.ahead(lane.to(scenario.drives().other()), 1, width, height).equals(at);
        } else {
            reached = false;
        }
        finished |= reached;
    }

    // -- what can be asked ----------------------------------------------------------------------------------------------

    public Scenario scenario() {
        return scenario;
    }

    /** Steps done so far; the step at hand is the next. */
    public int steps() {
        return steps;
    }

    public boolean finished() {
        return finished;
    }

    public boolean crashed(String driver) {
        return !scenario.isOpen() && crashed[index(driver)];
    }

    public WorldState snapshot() {
        Map<String, String> lights = new LinkedHashMap<>();
        for (int i = 0; i < phase.length; i++) {
            Scenario.Light light = scenario.lights().get(i);
            lights.put(light.name(), light.colour(phase[i]).toString());
        }
        Map<String, WorldState.Car> cars = new LinkedHashMap<>();
        for (int i = 0; i < names.length; i++) {
            cars.put(names[i], new WorldState.Car(x[i], y[i], heading[i].toString(), moved[i], crashed[i]));
        }
        return new WorldState(lights, cars, finished);
    }

    /**
     * The state in one line: two worlds of one scenario whose keys are equal have the same futures and look the same to the
     * driver.  Neither the choices of the step at hand nor a scripted car's last speed are part of it.
     */
    public String key() {
        StringBuilder out = new StringBuilder();
        for (int i = 0; i < phase.length; i++) {
            out.append(scenario.lights().get(i).name()).append('=').append(phase[i]).append(' ');
        }
        for (int i = 0; i < names.length; i++) {
            out.append(names[i]).append('=').append(x[i]).append(',').append(y[i]).append(',').append(heading[i]).append(',')
                    .append(i == DRIVER ? moved[i] : speed[i]).append(crashed[i] ? ",crashed " : " ");
        }
        return out.append(beside ? "beside " : "").append(finished ? "finished" : "").toString().strip();
    }

    /** Position in its cycle per light. */
    public Map<String, Integer> phases() {
        Map<String, Integer> out = new LinkedHashMap<>();
        for (int i = 0; i < phase.length; i++) {
            out.put(scenario.lights().get(i).name(), phase[i]);
        }
        return out;
    }

    /** Has the driver been beside the car it is to overtake? */
    public boolean beside() {
        return beside;
    }
}

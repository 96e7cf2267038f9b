package rotra.jason;

import java.io.PrintStream;
import java.util.ArrayList;
import java.util.Collections;
import java.util.HashMap;
import java.util.HashSet;
import java.util.LinkedHashMap;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;
import java.util.Random;
import java.util.Set;
import javax.json.Json;
import javax.json.JsonArrayBuilder;
import javax.json.JsonObject;
import javax.json.JsonObjectBuilder;
import rotra.world.Act;
import rotra.world.Cell;
import rotra.world.Percept;
import rotra.world.Scenario;
import rotra.world.Start;
import rotra.world.World;

/**
 * Every state of the running system: from every start, under every choice of who hesitates, the real agent in the real world.
 *
 * <pre>
 *     (world, who hesitates, mind)  --the agent deliberates on what it perceives-->  act  --the world moves-->  the next states
 * </pre>
 *
 * In: {@code {"agent", "rules", "world", "cap", "most", "chance"}}.  Out, a JSON object a line: the minds, the answers, the states
 * (numbers count from 0), and a summary.  Deliberation depends on mind and percepts alone, so the agent is asked once for each
 * such pair; a share of the pairs, `chance` of them, is asked again of another agent that came to its mind by another history.
 */
final class Explorer {

    /** How a mind was come by: in that mind, this was perceived, and the driver survived the step or did not.  No `from`: the start. */
    private record History(int from, List<Percept> seen, boolean alive) { }

    private record Pair(int mind, List<Percept> seen, boolean alive) { }

    /** `after`: the next mind of a driver that survives, and of one that crashes. */
    private record Answer(int number, Act act, boolean restless, int after, int afterCrash, String text) { }

    private record State(World world, int mind, Map<String, Integer> speeds) { }

    private static final int START = 0;
    private static final int NONE = -1;
    private static final int ASKED_AGAIN_AT_LEAST = 5;
    /** A mind that grows for ever has a new key in every step; the way to the last of so many is long. */
    private static final int MOST_MINDS = 400;

    private final JsonObject job;
    private final Scenario scenario;
    private final String driver;
    private final int most;
    private final PrintStream out;
    private final Redriven agent;
    private final Map<String, Integer> minds = new HashMap<>();
    private final List<History> histories = new ArrayList<>();
    private final Map<Integer, History> otherHistories = new HashMap<>();
    private final Map<Pair, Answer> answers = new LinkedHashMap<>();
    private final Map<String, Integer> numbers = new HashMap<>();
    private final List<State> states = new ArrayList<>();
    private final Set<Integer> used = new HashSet<>();
    private int live = NONE;

    Explorer(JsonObject job, PrintStream out) throws Exception {
        this.job = job;
        this.out = out;
        scenario = Scenario.read(job.getJsonObject("world"));
        driver = scenario.driver().name();
        most = job.getInt("most");
        agent = fresh();
    }

    private Redriven fresh() throws Exception {
        return new Redriven(job.getString("agent"), job.getString("rules"), scenario, job.getInt("cap", Job.CAP));
    }

    void explore() throws Exception {
        agent.restart();
        mind(agent, new History(NONE, List.of(), true));
        long begun = System.nanoTime();
        int edges = 0;
        JsonArrayBuilder starts = Json.createArrayBuilder();
        for (Start start : starts()) {
            World world = World.start(scenario, start);
            choices(world).forEach(w -> starts.add(number(new State(w, START, start.trafficSpeed()))));
        }
        for (int i = 0; i < states.size() && within(); i++) {
            edges += expand(i);
            states.set(i, null);
        }
        boolean whole = within();
        double seconds = (System.nanoTime() - begun) / 1e9;
        List<Pair> again = whole ? askedAgain() : List.of();
        List<String> differ = differing(again);
        out.println(Json.createObjectBuilder().add("summary", Json.createObjectBuilder().add("whole", whole).add("starts", starts)
                .add("states", states.size()).add("edges", edges).add("minds", used.size()).add("pairs", answers.size())
                .add("asked_again", again.size()).add("differ", Json.createArrayBuilder(differ)).add("states_per_second", Math.round(states.size() / Math.max(seconds, 1e-9)))).build());
    }

    private boolean within() {
        return states.size() <= most && minds.size() <= MOST_MINDS;
    }

    // -- the world ------------------------------------------------------------------------------------------------------

    /** All starts of the scenario in which every car has its own cell. */
    private List<Start> starts() {
        List<Start> found = new ArrayList<>();
        for (Cell at : scenario.driver().at().all()) {
            found.add(new Start(new int[] {at.x(), at.y()}, Map.of(), Map.of(), Map.of()));
        }
        for (Scenario.Light light : scenario.lights()) {
            found = each(found, light.phase().all(), (s, phase) -> new Start(s.driverAt(), with(s.phases(), light.name(), phase), s.trafficAt(), s.trafficSpeed()));
        }
        for (Scenario.ScriptedCar car : scenario.traffic()) {
            found = each(found, car.at().all(), (s, at) -> new Start(s.driverAt(), s.phases(), with(s.trafficAt(), car.name(), new int[] {at.x(), at.y()}), s.trafficSpeed()));
            found.removeIf(Explorer::shared);
            found = each(found, car.speed().all(), (s, speed) -> new Start(s.driverAt(), s.phases(), s.trafficAt(), with(s.trafficSpeed(), car.name(), speed)));
        }
        return found;
    }

    private static boolean shared(Start start) {
        Set<Cell> taken = new HashSet<>();
        taken.add(new Cell(start.driverAt()[0], start.driverAt()[1]));
        return !start.trafficAt().values().stream().allMatch(at -> taken.add(new Cell(at[0], at[1])));
    }

    private static <T> List<Start> each(List<Start> starts, List<T> values, java.util.function.BiFunction<Start, T, Start> with) {
        List<Start> found = new ArrayList<>();
        starts.forEach(start -> values.forEach(value -> found.add(with.apply(start, value))));
        return found;
    }

    private static <T> Map<String, T> with(Map<String, T> map, String name, T value) {
        Map<String, T> more = new LinkedHashMap<>(map);
        more.put(name, value);
        return more;
    }

    /** The world with every choice of who hesitates in the step at hand. */
    private static List<World> choices(World world) {
        List<String> may = world.mayHesitate();
        List<World> found = new ArrayList<>();
        for (int bits = 0; bits < 1 << may.size(); bits++) {
            Set<String> hesitate = new LinkedHashSet<>();
            for (int i = 0; i < may.size(); i++) {
                if ((bits >> i & 1) == 1) {
                    hesitate.add(may.get(i));
                }
            }
            World chosen = world.copy();
            chosen.setHesitating(hesitate);
            found.add(chosen);
        }
        return found;
    }

    private int number(State state) {
        return numbers.computeIfAbsent(state.world.key() + state.world.hesitating() + state.mind, k -> {
            states.add(state);
            return states.size() - 1;
        });
    }

    /** Writes the state and finds its successors; how many? */
    private int expand(int number) throws Exception {
        State state = states.get(number);
        boolean alive = !state.world.crashed(driver);
        Answer answer = answer(new Pair(state.mind, state.world.perceive(driver), alive));
        used.add(state.mind);
        JsonArrayBuilder next = Json.createArrayBuilder();
        int edges = 0;
        if (!answer.restless) {
            World moved = state.world.copy();
            moved.step(Map.of(driver, answer.act));
            int mind = !alive ? state.mind : moved.crashed(driver) ? answer.afterCrash : answer.after;
            for (World chosen : choices(moved)) {
                next.add(number(new State(chosen, mind, state.speeds)));
                edges++;
            }
        }
        out.println(Json.createObjectBuilder().add("state", shown(state).add("mind", state.mind).add("answer", answer.number).add("next", next)).build());
        return edges;
    }

    private JsonObjectBuilder shown(State state) {
        JsonObjectBuilder shown = Json.createObjectBuilder();
        state.world.snapshot().toJson().forEach(shown::add);
        return shown.add("phases", Json.createObjectBuilder(new LinkedHashMap<>(state.world.phases()))).add("speeds", Json.createObjectBuilder(new LinkedHashMap<>(state.speeds)))
                .add("beside", state.world.beside()).add("hesitates", Json.createArrayBuilder(state.world.hesitating()));
    }

    // -- the mind -------------------------------------------------------------------------------------------------------

    /** The number of the mind that the agent is in, and how it came there. */
    private int mind(Redriven agent, History history) {
        String key = agent.key();
        Integer known = minds.get(key);
        if (known != null) {
            if (!histories.get(known).equals(history)) {
                otherHistories.putIfAbsent(known, history);
            }
            return known;
        }
        int number = minds.size();
        minds.put(key, number);
        histories.add(history);
        out.println(Json.createObjectBuilder().add("mind", Json.createObjectBuilder().add("own", Json.createArrayBuilder(agent.own()))
                .add("watched", Json.createArrayBuilder(agent.watched())).add("key", key)).build());
        return number;
    }

    /** Brings an agent into a mind by driving it there from its start. */
    private void bring(Redriven agent, History history) {
        if (history.from == NONE) {
            agent.restart();
            return;
        }
        bring(agent, histories.get(history.from));
        agent.sense(history.seen);
        if (history.alive) {
            agent.survive();
        }
    }

    private Answer answer(Pair pair) throws Exception {
        Answer known = answers.get(pair);
        if (known != null) {
            return known;
        }
        if (live != pair.mind) {
            bring(agent, histories.get(pair.mind));
        }
        Answer answer = ask(agent, pair, answers.size());
        live = pair.alive && !answer.restless ? answer.after : NONE;
        answers.put(pair, answer);
        JsonArrayBuilder percepts = Json.createArrayBuilder();
        pair.seen.forEach(p -> percepts.add(p.toString()));
        out.println("{\"answer\":{\"percepts\":" + percepts.build() + ",\"rest\":" + answer.text + "}}");
        return answer;
    }

    private Answer ask(Redriven agent, Pair pair, int number) {
        boolean alive = pair.alive;
        if (alive) {
            agent.sense(pair.seen);
        } else {
            agent.crash();
        }
        JsonObjectBuilder rest = Json.createObjectBuilder();
        agent.read(alive, rest);
        String text = rest.build().toString();
        Act act = agent.act();
        if (!alive || agent.restless()) {
            return new Answer(number, act, agent.restless(), pair.mind, pair.mind, text);
        }
        int afterCrash = mind(agent, new History(pair.mind, pair.seen, false));
        agent.survive();
        return new Answer(number, act, false, mind(agent, new History(pair.mind, pair.seen, true)), afterCrash, text);
    }

    /** A share of the pairs, drawn evenly, but some at least. */
    private List<Pair> askedAgain() {
        List<Pair> pairs = new ArrayList<>(answers.keySet());
        pairs.removeIf(pair -> answers.get(pair).restless);
        Collections.shuffle(pairs, new Random(1));
        int share = (int) Math.ceil(pairs.size() * job.getJsonNumber("chance").doubleValue());
        return pairs.subList(0, Math.min(pairs.size(), Math.max(share, ASKED_AGAIN_AT_LEAST)));
    }

    /** The pairs asked of another agent, by another history where there is one: those that are answered otherwise. */
    private List<String> differing(List<Pair> pairs) throws Exception {
        Redriven other = fresh();
        List<String> differ = new ArrayList<>();
        int known = minds.size();
        for (Pair pair : pairs) {
            Answer answer = answers.get(pair);
            bring(other, otherHistories.getOrDefault(pair.mind, histories.get(pair.mind)));
            Answer again = ask(other, pair, answer.number);
            if (!again.equals(answer) || minds.size() > known) {
                differ.add("mind " + pair.mind + " perceives " + pair.seen + ": " + answer.text + " and " + again.text);
            }
        }
        return differ;
    }
}

package rotra.world;

import java.util.ArrayList;
import java.util.Collections;
import java.util.HashSet;
import java.util.List;
import java.util.Random;
import java.util.Set;

/**
 * What may be perceived where there is no road: any of the declared percepts, of an exclusion's at most one, and exactly one
 * of what a car always knows (its speed, ..).
 */
final class OpenPercepts {

    private static final List<String> ALWAYS = List.of("drives", "heading", "limit", "speed", "task");

    private final Scenario scenario;
    private final Random random;
    private final Set<Integer> used = new HashSet<>();
    private final List<Percept> drawn = new ArrayList<>();

    private OpenPercepts(Scenario scenario, Random random) {
        this.scenario = scenario;
        this.random = random;
    }

    /** One of each kind that always holds; then, in random order, each other percept with even odds unless one drawn before excludes it. */
    static List<Percept> draw(Scenario scenario, Random random) {
        OpenPercepts open = new OpenPercepts(scenario, random);
        for (String functor : ALWAYS) {
            for (Percept percept : open.shuffled(scenario.percepts().stream().filter(p -> p.functor().equals(functor)).toList())) {
                if (open.take(percept)) {
                    break;
                }
            }
        }
        for (Percept percept : open.shuffled(scenario.percepts().stream().filter(p -> !ALWAYS.contains(p.functor())).toList())) {
            if (random.nextBoolean()) {
                open.take(percept);
            }
        }
        return open.drawn;
    }

    private List<Percept> shuffled(List<Percept> percepts) {
        List<Percept> order = new ArrayList<>(percepts);
        Collections.shuffle(order, random);
        return order;
    }

    private boolean take(Percept percept) {
        Set<Integer> groups = new HashSet<>();
        for (int i = 0; i < scenario.exclusions().size(); i++) {
            if (scenario.exclusions().get(i).stream().anyMatch(percept::matches)) {
                groups.add(i);
            }
        }
        if (!Collections.disjoint(groups, used)) {
            return false;
        }
        used.addAll(groups);
        return drawn.add(percept);
    }
}

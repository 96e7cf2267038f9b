package rotra.world;

import java.util.ArrayList;
import java.util.Collections;
import java.util.HashSet;
import java.util.List;
import java.util.Random;
import java.util.Set;

/** What may be perceived where there is no road: any of the declared percepts, of an exclusion's at most one. */
final class OpenPercepts {

    private OpenPercepts() { }

    /** Each percept with even odds, in random order, unless one that excludes it has been drawn before. */
    static List<Percept> draw(Scenario scenario, Random random) {
        List<Percept> order = new ArrayList<>(scenario.percepts());
        Collections.shuffle(order, random);
        Set<Integer> used = new HashSet<>();
        List<Percept> drawn = new ArrayList<>();
        for (Percept percept : order) {
            if (!random.nextBoolean()) {
                continue;
            }
            Set<Integer> groups = groups(scenario, percept);
            if (Collections.disjoint(groups, used)) {
                used.addAll(groups);
                drawn.add(percept);
            }
        }
        return drawn;
    }

    private static Set<Integer> groups(Scenario scenario, Percept percept) {
        Set<Integer> groups = new HashSet<>();
        for (int i = 0; i < scenario.exclusions().size(); i++) {
            if (scenario.exclusions().get(i).stream().anyMatch(percept::matches)) {
                groups.add(i);
            }
        }
        return groups;
    }
}

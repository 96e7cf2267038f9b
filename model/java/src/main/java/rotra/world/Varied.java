package rotra.world;

import java.util.List;
import java.util.Random;

/** A value that a scenario may vary: the published one and all of them. */
public record Varied<T>(T published, List<T> all) {

    public Varied {
        all = all.isEmpty() ? List.of(published) : List.copyOf(all);
    }

    T any(Random random) {
        return all.size() == 1 ? all.get(0) : all.get(random.nextInt(all.size()));
    }
}

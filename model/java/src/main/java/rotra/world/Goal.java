package rotra.world;

import java.util.List;

/** When a scenario is finished; what each one means is said in model/README.md. */
public sealed interface Goal {

    /** The driver is on one of the cells. */
    record InCells(List<Cell> cells) implements Goal { }

    /** The driver is on the cell so many cells past the stop line of that light. */
    record Beyond(String light, int cells) implements Goal { }

    /** The driver has been beside that car and is now 1 to `within` cells ahead of it in its lane. */
    record Overtaken(String car, int within) implements Goal { }

    /** There is nothing to finish. */
    record None() implements Goal { }
}

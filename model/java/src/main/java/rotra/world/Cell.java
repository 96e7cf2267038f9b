package rotra.world;

/** A cell of the grid: x grows east, y grows south. */
public record Cell(int x, int y) {

    /** The cell `steps` further towards `heading`, in a world that wraps at every edge. */
    public Cell ahead(Heading heading, int steps, int width, int height) {
        return new Cell(Math.floorMod(x + steps * heading.dx, width), Math.floorMod(y + steps * heading.dy, height));
    }
}

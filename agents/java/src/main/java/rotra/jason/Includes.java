package rotra.jason;

import jason.asSemantics.Agent;
import jason.asSyntax.ASSyntax;
import jason.asSyntax.Pred;
import jason.asSyntax.StringTerm;
import jason.asSyntax.directives.DirectiveProcessor;
import jason.asSyntax.directives.Include;
import java.nio.file.Files;
import java.nio.file.Path;

/**
 * Where an included file is: beside the file that includes it, else among the agent files that ship.
 *
 * <p>In: the name as it stands in the directive.  Out: Jason's include of that very file.  Jason's own look-up starts in the
 * working directory, knows no `..` and loses the leading slash of a path.
 */
public final class Includes extends Include {

    private static final String FILE = "file:";
    /** The folder of the agent files that ship; set by whoever starts this program. */
    private static final String SHIPPED = System.getProperty("rotra.agents");

    /** From now on every include is looked up so. */
    static void use() {
        DirectiveProcessor.registerDirective("include", Includes.class);
    }

    @Override
    public Agent process(Pred directive, Agent outer, Agent inner) {
        String source = outer == null ? null : outer.getASLSrc();
        if (source != null && directive.getTerm(0) instanceof StringTerm name) {
            Path file = resolve(name.getString(), Path.of(source.startsWith(FILE) ? source.substring(FILE.length()) : source));
            directive.setTerm(0, ASSyntax.createString(FILE + file));
        }
        return super.process(directive, outer, inner);
    }

    /** The file meant by `name` in the file `from`, absolute; it need not exist. */
    static Path resolve(String name, Path from) {
        Path beside = from.toAbsolutePath().resolveSibling(name).normalize();
        Path shipped = SHIPPED == null ? beside : Path.of(SHIPPED).resolve(name).normalize();
        return Files.isRegularFile(beside) || !Files.isRegularFile(shipped) ? beside : shipped;
    }
}

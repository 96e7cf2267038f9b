package rotra.bench;

import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.List;
import java.util.concurrent.TimeUnit;
import javax.json.JsonObject;
import org.openjdk.jmh.annotations.Benchmark;
import org.openjdk.jmh.annotations.BenchmarkMode;
import org.openjdk.jmh.annotations.Mode;
import org.openjdk.jmh.annotations.OutputTimeUnit;
import org.openjdk.jmh.annotations.Param;
import org.openjdk.jmh.annotations.Scope;
import org.openjdk.jmh.annotations.Setup;
import org.openjdk.jmh.annotations.State;
import rotra.advice.Advice;
import rotra.advice.Adviser;
import rotra.advice.Answers;

/** One query of the adviser, the situations of a file in turn; both files are given on the command line with {@code -p}. */
@State(Scope.Thread)
@BenchmarkMode(Mode.SampleTime)
@OutputTimeUnit(TimeUnit.MICROSECONDS)
public class Query {

    private record Situation(String context, List<String> beliefs, List<String> intentions) { }

    @Param("")
    public String rules;

    @Param("")
    public String situations;

    private Adviser adviser;
    private Situation[] asked;
    private int next;

    @Setup
    public void read() throws IOException {
        adviser = Answers.read(Path.of(rules));
        asked = Files.readAllLines(Path.of(situations)).stream().map(Query::situation).toArray(Situation[]::new);
    }

    @Benchmark
    public Advice advise() {
        Situation situation = asked[next];
        next = next + 1 == asked.length ? 0 : next + 1;
        return adviser.advise(situation.context, situation.beliefs, situation.intentions);
    }

    private static Situation situation(String line) {
        JsonObject said = Answers.object(line);
        return new Situation(said.getString("context"), Answers.texts(said, "beliefs"), Answers.texts(said, "intentions"));
    }
}

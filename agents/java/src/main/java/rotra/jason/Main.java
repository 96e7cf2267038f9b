package rotra.jason;

import java.io.PrintStream;
import java.nio.charset.StandardCharsets;
import javax.json.Json;
import javax.json.JsonArrayBuilder;
import javax.json.JsonObject;
import javax.json.JsonReader;
import javax.json.JsonString;
import javax.json.JsonValue;

/** {@code Main parse|formula|run|bench|explore}: one JSON job on standard input, its answer on standard output. */
public final class Main {

    private Main() { }

    public static void main(String[] args) {
        PrintStream out = new PrintStream(System.out, false, StandardCharsets.UTF_8);
        // Standard output carries the answer and nothing else, whatever an agent prints.
        System.setOut(System.err);
        Quiet.please();
        Includes.use();
        JsonObject job;
        try (JsonReader reader = Json.createReader(System.in)) {
            job = reader.readObject();
        }
        switch (args.length == 0 ? "" : args[0]) {
            case "parse" -> out.println(parse(job));
            case "formula" -> out.println(formulas(job));
            case "run" -> out.println(run(job));
            case "bench" -> out.println(bench(job));
            case "explore" -> explore(job, out);
            default -> {
                System.err.println("usage: Main parse|formula|run|bench|explore");
                System.exit(2);
            }
        }
        out.flush();
        System.exit(0);
    }

    static JsonObject parse(JsonObject job) {
        JsonArrayBuilder agents = Json.createArrayBuilder();
        for (JsonString file : job.getJsonArray("files").getValuesAs(JsonString.class)) {
            agents.add(ParserExport.export(file.getString()));
        }
        return Json.createObjectBuilder().add("agents", agents).build();
    }

    static JsonObject formulas(JsonObject job) {
        JsonArrayBuilder formulas = Json.createArrayBuilder();
        for (JsonValue formula : job.getJsonArray("formulas")) {
            formulas.add(ParserExport.formula(formula.asJsonObject()));
        }
        return Json.createObjectBuilder().add("formulas", formulas).build();
    }

    static JsonObject run(JsonObject job) {
        try {
            return new Lockstep(Job.read(job)).run();
        } catch (Exception e) {
            throw new IllegalStateException("the driver " + job.getString("agent") + " cannot be run: " + e.getMessage(), e);
        }
    }

    /** Every state of the running system, a JSON object a line. */
    static void explore(JsonObject job, PrintStream out) {
        try {
            new Explorer(job, out).explore();
        } catch (Exception e) {
            throw new IllegalStateException("the driver " + job.getString("agent") + " cannot be explored: " + e.getMessage(), e);
        }
    }

    /** Steps a second without a trace: after a run to warm up, the runs one by one. */
    static JsonObject bench(JsonObject job) {
        int runs = job.getInt("runs", 5);
        JsonObject silent = Json.createObjectBuilder(job).add("trace", false).build();
        JsonArrayBuilder rates = Json.createArrayBuilder();
        for (int i = 0; i <= runs; i++) {
            long rate = run(silent).getJsonNumber("steps_per_second").longValue();
            if (i > 0) {
                rates.add(rate);
            }
        }
        return Json.createObjectBuilder().add("steps_per_second", rates).build();
    }
}

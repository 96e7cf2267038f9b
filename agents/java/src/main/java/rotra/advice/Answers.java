package rotra.advice;

import java.io.BufferedReader;
import java.io.IOException;
import java.io.InputStreamReader;
import java.io.PrintWriter;
import java.io.StringReader;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.List;
import javax.json.Json;
import javax.json.JsonArray;
import javax.json.JsonArrayBuilder;
import javax.json.JsonObject;
import javax.json.JsonObjectBuilder;
import javax.json.JsonReader;
import javax.json.JsonString;

/** {@code Answers RULES.json}: a situation a line on standard input, its advice a line on standard output, as {@code rotra advise --from}. */
public final class Answers {

    private Answers() { }

    public static void main(String[] args) throws IOException {
        Adviser adviser = read(Path.of(args[0]));
        BufferedReader in = new BufferedReader(new InputStreamReader(System.in, StandardCharsets.UTF_8));
        try (PrintWriter out = new PrintWriter(System.out, false, StandardCharsets.UTF_8)) {
            for (String line = in.readLine(); line != null; line = in.readLine()) {
                JsonObject situation = object(line);
                out.println(json(adviser.advise(situation.getString("context"), texts(situation, "beliefs"), texts(situation, "intentions"))));
            }
        }
    }

    /** The adviser of a file that {@code rotra} compiled. */
    public static Adviser read(Path rules) throws IOException {
        try (JsonReader reader = Json.createReader(Files.newBufferedReader(rules))) {
            return Adviser.compile(reader.readObject());
        }
    }

    public static JsonObject object(String line) {
        try (JsonReader reader = Json.createReader(new StringReader(line))) {
            return reader.readObject();
        }
    }

    public static List<String> texts(JsonObject situation, String key) {
        JsonArray array = situation.getJsonArray(key);
        return array == null ? List.of() : array.getValuesAs(JsonString.class).stream().map(JsonString::getString).toList();
    }

    static JsonObject json(Advice advice) {
        JsonArrayBuilder directives = Json.createArrayBuilder();
        for (Advice.Advised advised : advice.directives()) {
            JsonObjectBuilder entry = Json.createObjectBuilder()
                    .add("label", advised.directive().label())
                    .add("action", advised.directive().action())
                    .add("rules", Json.createArrayBuilder(advised.rules()));
            if (!advised.outrankedBy().isEmpty()) {
                entry.add("outranked_by", Json.createArrayBuilder(advised.outrankedBy()));
            }
            directives.add(entry);
        }
        return Json.createObjectBuilder().add("directives", directives).add("unknown", Json.createArrayBuilder(advice.unknown())).build();
    }
}

package rotra.advice;

import java.util.ArrayList;
import java.util.Arrays;
import java.util.Collection;
import java.util.Comparator;
import java.util.HashMap;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.stream.IntStream;
import java.util.stream.LongStream;
import java.util.stream.Stream;
import javax.json.JsonArray;
import javax.json.JsonObject;
import javax.json.JsonString;

/**
 * What the rules demand in a situation, by the set definition; the Java side of the translator's {@code advice.py}.
 *
 * <p>In: the compiled rule base that {@code emitters/compiled.py} writes; situations.  Out: {@link Advice}.  A situation becomes
 * a set of bits, one a term.  Each rule is filed under one of the terms that it needs (the rarest), so that only rules that may
 * apply are looked at, and what is filed under a term lies in one piece of memory, as a large rule base is in no cache.  An
 * adviser never changes, and many threads may ask it.
 */
public final class Adviser {

    /**
     * The rules of one context by the term that they are filed under, those that need none in the last place.
     *
     * @param sure what the rules give that ask for nothing more, each directive and rule in one number (see {@link #given})
     * @param checked the other rules, one after the other: the rule, then what else it needs, what it forbids and what it gives,
     *     each list after its length
     */
    private record Filed(long[][] sure, int[][] checked) { }

    private static final class Found {

        private long[] given = new long[32];
        private int size;

        void room(int more) {
            if (size + more > given.length) {
                given = Arrays.copyOf(given, 2 * (size + more));
            }
        }
    }

    private final Map<String, Integer> beliefs;
    private final Map<String, Integer> intentions;
    private final Map<String, Filed> contexts;
    private final int terms;
    private final Directive[] directives;
    private final int[][] opposed;
    private final String[] ids;
    private final int[] authority;

    private Adviser(JsonObject base) {
        beliefs = numbered(base.getJsonObject("beliefs"));
        intentions = numbered(base.getJsonObject("intentions"));
        terms = 1 + Stream.of(beliefs, intentions).flatMap(table -> table.values().stream()).mapToInt(Integer::intValue).max().orElse(-1);
        directives = base.getJsonArray("directives").getValuesAs(JsonArray.class).stream()
                .map(pair -> new Directive(pair.getString(0), pair.getString(1))).toArray(Directive[]::new);
        opposed = base.getJsonArray("opposed").getValuesAs(JsonArray.class).stream().map(Adviser::ints).toArray(int[][]::new);
        List<JsonObject> rules = base.getJsonArray("rules").getValuesAs(JsonObject.class);
        ids = rules.stream().map(rule -> rule.getString("id")).toArray(String[]::new);
        authority = rules.stream().mapToInt(rule -> rule.getInt("authority")).toArray();
        int[] common = new int[terms];
        rules.forEach(rule -> Arrays.stream(ints(rule.getJsonArray("needs"))).forEach(term -> common[term]++));
        contexts = new HashMap<>();
        for (JsonString context : base.getJsonArray("contexts").getValuesAs(JsonString.class)) {
            contexts.put(context.getString(), filed(context.getString(), rules, common));
        }
    }

    /** The adviser of a compiled rule base. */
    public static Adviser compile(JsonObject rules) {
        return new Adviser(rules);
    }

    /** The advice of one situation; a word may be a term or an alias. */
    public Advice advise(String context, Collection<String> believed, Collection<String> intended) {
        long[] held = new long[(terms + 63) >>> 6];
        int[] said = new int[believed.size() + intended.size()];
        Set<String> unknown = new LinkedHashSet<>(0);
        int known = hold(believed, beliefs, held, said, 0, unknown);
        known = hold(intended, intentions, held, said, known, unknown);
        Filed filed = contexts.get(context);
        if (filed == null) {
            List<String> unheard = new ArrayList<>(unknown);
            unheard.add(0, context);
            return new Advice(List.of(), List.copyOf(unheard));
        }
        Found found = new Found();
        collect(filed, terms, held, found);
        for (int n = 0; n < known; n++) {
            collect(filed, said[n], held, found);
        }
        // One sort puts the directives in the order of advice and the rules of each in the order of the base.
        Arrays.sort(found.given, 0, found.size);
        return new Advice(advised(found.given, found.size), unknown.isEmpty() ? List.of() : List.copyOf(unknown));
    }

    private static int hold(Collection<String> told, Map<String, Integer> known, long[] held, int[] said, int from, Set<String> unknown) {
        int next = from;
        for (String word : told) {
            Integer term = known.get(word);
            if (term == null) {
                unknown.add(word);
            } else if (!has(held, term)) {
                held[term >>> 6] |= 1L << term;
                said[next++] = term;
            }
        }
        return next;
    }

    private static void collect(Filed filed, int term, long[] held, Found found) {
        long[] sure = filed.sure[term];
        if (sure != null) {
            found.room(sure.length);
            System.arraycopy(sure, 0, found.given, found.size, sure.length);
            found.size += sure.length;
        }
        int[] checked = filed.checked[term];
        if (checked == null) {
            return;
        }
        for (int at = 0; at < checked.length;) {
            int rule = checked[at++];
            boolean applies = true;
            for (int end = at + 1 + checked[at++]; at < end; at++) {
                applies &= has(held, checked[at]);
            }
            for (int end = at + 1 + checked[at++]; at < end; at++) {
                applies &= !has(held, checked[at]);
            }
            int gives = checked[at++];
            if (applies) {
                found.room(gives);
                for (int n = 0; n < gives; n++) {
                    found.given[found.size++] = given(checked[at + n], rule);
                }
            }
            at += gives;
        }
    }

    /** A directive and a rule behind it in one number, which sorts by directive, then by rule. */
    private static long given(int directive, int rule) {
        return (long) directive << 32 | rule;
    }

    private List<Advice.Advised> advised(long[] found, int size) {
        List<Advice.Advised> advised = new ArrayList<>();
        for (int from = 0, to; from < size; from = to) {
            int directive = (int) (found[from] >>> 32);
            to = after(found, from, size);
            String[] rules = new String[to - from];
            for (int n = from; n < to; n++) {
                rules[n - from] = ids[(int) found[n]];
            }
            advised.add(new Advice.Advised(directives[directive], List.of(rules), outranking(directive, from, to, found, size)));
        }
        return List.copyOf(advised);
    }

    /** The rules against a directive, found from {@code from} to {@code to}, that rank above all the rules for it. */
    private List<String> outranking(int directive, int from, int to, long[] found, int size) {
        if (opposed.length == 0 || opposed[directive].length == 0) {
            return List.of();
        }
        int best = Integer.MAX_VALUE;
        for (int n = from; n < to; n++) {
            best = Math.min(best, authority[(int) found[n]]);
        }
        Set<String> against = new LinkedHashSet<>(0);
        for (int other : opposed[directive]) {
            int place = Arrays.binarySearch(found, 0, size, given(other, 0));
            for (int n = place < 0 ? -place - 1 : place; n < size && found[n] >>> 32 == other; n++) {
                if (authority[(int) found[n]] < best) {
                    against.add(ids[(int) found[n]]);
                }
            }
        }
        return List.copyOf(against);
    }

    private static int after(long[] found, int from, int size) {
        int to = from + 1;
        while (to < size && found[to] >>> 32 == found[from] >>> 32) {
            to++;
        }
        return to;
    }

    private static boolean has(long[] held, int term) {
        return (held[term >>> 6] & 1L << term) != 0;
    }

    /** Files each rule of a context under the rarest term that it needs. */
    private Filed filed(String context, List<JsonObject> rules, int[] common) {
        Map<Integer, LongStream.Builder> sure = new HashMap<>();
        Map<Integer, IntStream.Builder> checked = new HashMap<>();
        for (int number = 0; number < rules.size(); number++) {
            JsonObject rule = rules.get(number);
            if (!rule.getString("context").equals(context)) {
                continue;
            }
            int[] needs = ints(rule.getJsonArray("needs"));
            int[] unless = ints(rule.getJsonArray("unless"));
            int[] gives = ints(rule.getJsonArray("gives"));
            int under = Arrays.stream(needs).boxed().min(Comparator.comparingInt(term -> common[term])).orElse(terms);
            if (needs.length <= 1 && unless.length == 0) {
                LongStream.Builder into = sure.computeIfAbsent(under, term -> LongStream.builder());
                for (int directive : gives) {
                    into.add(given(directive, number));
                }
            } else {
                IntStream.Builder into = checked.computeIfAbsent(under, term -> IntStream.builder()).add(number);
                for (int[] list : List.of(Arrays.stream(needs).filter(term -> term != under).toArray(), unless, gives)) {
                    into.add(list.length);
                    Arrays.stream(list).forEach(into::add);
                }
            }
        }
        Filed filed = new Filed(new long[terms + 1][], new int[terms + 1][]);
        sure.forEach((term, given) -> filed.sure[term] = given.build().sorted().toArray());
        checked.forEach((term, program) -> filed.checked[term] = program.build().toArray());
        return filed;
    }

    private static Map<String, Integer> numbered(JsonObject table) {
        Map<String, Integer> numbers = new HashMap<>();
        table.keySet().forEach(word -> numbers.put(word, table.getInt(word)));
        return numbers;
    }

    private static int[] ints(JsonArray array) {
        int[] ints = new int[array.size()];
        for (int n = 0; n < ints.length; n++) {
            ints[n] = array.getInt(n);
        }
        return ints;
    }
}

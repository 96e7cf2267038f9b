package rotra.advice;

import java.util.ArrayList;
import java.util.Arrays;
import java.util.Collection;
import java.util.HashMap;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;
import java.util.Set;
import javax.json.JsonArray;
import javax.json.JsonObject;
import javax.json.JsonString;

/**
 * What the rules demand in a situation, by the set definition; the Java side of the translator's {@code advice.py}.
 *
 * <p>In: the compiled rule base that {@code emitters/compiled.py} writes; situations.  Out: {@link Advice}.  A situation becomes
 * a set of bits, one a term.  Each rule is filed under one of the terms that it needs (the rarest), so that only rules that may
 * apply are looked at.  An adviser never changes, and many threads may ask it.
 */
public final class Adviser {

    private static final int[] NONE = {};

    /** The rules of one context: those that need nothing, and for each term those that are filed under it. */
    private record Filed(int[] always, int[][] under) { }

    private final Map<String, Integer> beliefs;
    private final Map<String, Integer> intentions;
    private final Map<String, Filed> contexts;
    private final int words;
    private final Directive[] directives;
    private final int[][] opposed;
    private final String[] ids;
    private final int[][] needs;
    private final int[][] unless;
    private final int[][] gives;
    private final int[] authority;

    private Adviser(JsonObject base) {
        beliefs = numbered(base.getJsonObject("beliefs"));
        intentions = numbered(base.getJsonObject("intentions"));
        int terms = 0;
        for (Map<String, Integer> table : List.of(beliefs, intentions)) {
            for (int term : table.values()) {
                terms = Math.max(terms, term + 1);
            }
        }
        words = (terms + 63) >>> 6;
        directives = base.getJsonArray("directives").getValuesAs(JsonArray.class).stream()
                .map(pair -> new Directive(pair.getString(0), pair.getString(1))).toArray(Directive[]::new);
        opposed = base.getJsonArray("opposed").getValuesAs(JsonArray.class).stream().map(Adviser::ints).toArray(int[][]::new);
        List<JsonObject> rules = base.getJsonArray("rules").getValuesAs(JsonObject.class);
        ids = rules.stream().map(rule -> rule.getString("id")).toArray(String[]::new);
        needs = rules.stream().map(rule -> ints(rule.getJsonArray("needs"))).toArray(int[][]::new);
        unless = rules.stream().map(rule -> ints(rule.getJsonArray("unless"))).toArray(int[][]::new);
        gives = rules.stream().map(rule -> ints(rule.getJsonArray("gives"))).toArray(int[][]::new);
        authority = rules.stream().mapToInt(rule -> rule.getInt("authority")).toArray();
        contexts = new HashMap<>();
        int[] common = new int[terms];
        for (int[] needed : needs) {
            for (int term : needed) {
                common[term]++;
            }
        }
        for (JsonString context : base.getJsonArray("contexts").getValuesAs(JsonString.class)) {
            contexts.put(context.getString(), filed(context.getString(), rules, terms, common));
        }
    }

    /** The adviser of a compiled rule base. */
    public static Adviser compile(JsonObject rules) {
        return new Adviser(rules);
    }

    /** The advice of one situation; a word may be a term or an alias. */
    public Advice advise(String context, Collection<String> believed, Collection<String> intended) {
        long[] held = new long[words];
        int[] terms = new int[believed.size() + intended.size()];
        Set<String> unknown = new LinkedHashSet<>(0);
        int known = hold(believed, beliefs, held, terms, 0, unknown);
        known = hold(intended, intentions, held, terms, known, unknown);
        Filed filed = contexts.get(context);
        if (filed == null) {
            List<String> said = new ArrayList<>(unknown);
            said.add(0, context);
            return new Advice(List.of(), List.copyOf(said));
        }
        long[] found = new long[16];
        int size = 0;
        found = collect(filed.always, held, found, size);
        size = (int) found[0];
        for (int n = 0; n < known; n++) {
            found = collect(filed.under[terms[n]], held, found, size);
            size = (int) found[0];
        }
        Arrays.sort(found, 1, size + 1);
        return new Advice(advised(found, size), unknown.isEmpty() ? List.of() : List.copyOf(unknown));
    }

    private static int hold(Collection<String> said, Map<String, Integer> known, long[] held, int[] terms, int from, Set<String> unknown) {
        int next = from;
        for (String word : said) {
            Integer term = known.get(word);
            if (term == null) {
                unknown.add(word);
            } else if (!has(held, term)) {
                held[term >>> 6] |= 1L << term;
                terms[next++] = term;
            }
        }
        return next;
    }

    /**
     * Adds what the rules that apply give, as directive and rule in one number, so that one sort puts both in order.  The
     * first place of {@code found} holds how many there are.
     */
    private long[] collect(int[] candidates, long[] held, long[] found, int before) {
        long[] into = found;
        int size = before;
        for (int rule : candidates) {
            if (applies(rule, held)) {
                for (int directive : gives[rule]) {
                    if (++size == into.length) {
                        into = Arrays.copyOf(into, 2 * into.length);
                    }
                    into[size] = (long) directive << 32 | rule;
                }
            }
        }
        into[0] = size;
        return into;
    }

    private boolean applies(int rule, long[] held) {
        for (int term : needs[rule]) {
            if (!has(held, term)) {
                return false;
            }
        }
        for (int term : unless[rule]) {
            if (has(held, term)) {
                return false;
            }
        }
        return true;
    }

    private List<Advice.Advised> advised(long[] found, int size) {
        List<Advice.Advised> advised = new ArrayList<>();
        for (int from = 1, to; from <= size; from = to) {
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
            int place = Arrays.binarySearch(found, 1, size + 1, (long) other << 32);
            for (int n = place < 0 ? -place - 1 : place; n <= size && found[n] >>> 32 == other; n++) {
                if (authority[(int) found[n]] < best) {
                    against.add(ids[(int) found[n]]);
                }
            }
        }
        return List.copyOf(against);
    }

    private static int after(long[] found, int from, int size) {
        int to = from + 1;
        while (to <= size && found[to] >>> 32 == found[from] >>> 32) {
            to++;
        }
        return to;
    }

    private static boolean has(long[] held, int term) {
        return (held[term >>> 6] & 1L << term) != 0;
    }

    /** Files each rule of a context under the rarest term that it needs. */
    private Filed filed(String context, List<JsonObject> rules, int terms, int[] common) {
        List<Integer> always = new ArrayList<>();
        Map<Integer, List<Integer>> under = new HashMap<>();
        for (int rule = 0; rule < needs.length; rule++) {
            if (!rules.get(rule).getString("context").equals(context)) {
                continue;
            }
            int rarest = -1;
            for (int term : needs[rule]) {
                rarest = rarest < 0 || common[term] < common[rarest] ? term : rarest;
            }
            (rarest < 0 ? always : under.computeIfAbsent(rarest, term -> new ArrayList<>())).add(rule);
        }
        int[][] table = new int[terms][];
        Arrays.fill(table, NONE);
        under.forEach((term, filed) -> table[term] = filed.stream().mapToInt(Integer::intValue).toArray());
        return new Filed(always.stream().mapToInt(Integer::intValue).toArray(), table);
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

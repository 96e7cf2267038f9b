package rotra.advice;

import java.util.List;

/**
 * The answer to one situation.
 *
 * @param directives in the order of advice (by rank of the label, then by action), each with the rules behind it
 * @param unknown the words that the rule base does not know, each once
 */
public record Advice(List<Advised> directives, List<String> unknown) {

    /**
     * @param rules the ids of the rules that ask for it, in the order of the rule base
     * @param outrankedBy the rules of a higher authority that ask for the opposite; empty where there are none
     */
    public record Advised(Directive directive, List<String> rules, List<String> outrankedBy) { }
}

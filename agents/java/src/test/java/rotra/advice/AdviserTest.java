package rotra.advice;

import static org.junit.jupiter.api.Assertions.assertEquals;

import java.util.List;
import org.junit.jupiter.api.Test;

/** A small rule base: order, exceptions, aliases, unknown words, authorities. */
class AdviserTest {

    private static final Adviser SMALL = Adviser.compile(Answers.object("""
            {"contexts": ["standard", "emergency"],
             "beliefs": {"red": 0, "lightRed": 0, "officer_waves": 1, "night": 2}, "intentions": {"cross": 70},
             "directives": [["must", "go"], ["must", "stop"], ["should", "look"]],
             "opposed": [[1], [0], []],
             "rules": [
               {"id": "r1", "context": "standard", "needs": [0], "unless": [], "gives": [1, 2], "authority": 1},
               {"id": "r2", "context": "standard", "needs": [], "unless": [2], "gives": [2], "authority": 1},
               {"id": "r3", "context": "standard", "needs": [1, 70], "unless": [], "gives": [0], "authority": 0},
               {"id": "r4", "context": "emergency", "needs": [0], "unless": [], "gives": [0], "authority": 1}]}"""));

    private static Advice.Advised advised(String label, String action, List<String> rules, String... outranking) {
        return new Advice.Advised(new Directive(label, action), rules, List.of(outranking));
    }

    @Test
    void everyRuleBehindADirectiveIsNamedInOrder() {
        assertEquals(
                List.of(advised("must", "stop", List.of("r1")), advised("should", "look", List.of("r1", "r2"))),
                SMALL.advise("standard", List.of("red"), List.of()).directives());
    }

    @Test
    void anAliasAndARepeatedWordChangeNothing() {
        assertEquals(
                SMALL.advise("standard", List.of("red"), List.of()),
                SMALL.advise("standard", List.of("lightRed", "red", "lightRed"), List.of()));
    }

    @Test
    void anExceptionTakesTheRuleAway() {
        assertEquals(List.of(), SMALL.advise("standard", List.of("night"), List.of()).directives());
    }

    @Test
    void aHigherAuthorityIsMarkedAndNothingIsHidden() {
        assertEquals(
                List.of(
                        advised("must", "go", List.of("r3")),
                        advised("must", "stop", List.of("r1"), "r3"),
                        advised("should", "look", List.of("r1", "r2"))),
                SMALL.advise("standard", List.of("red", "officer_waves"), List.of("cross")).directives());
    }

    @Test
    void aContextHasItsOwnRules() {
        assertEquals(List.of(advised("must", "go", List.of("r4"))), SMALL.advise("emergency", List.of("red"), List.of()).directives());
    }

    @Test
    void unknownWordsAreSaidOnceTheContextFirst() {
        assertEquals(List.of("odd", "x", "red"), SMALL.advise("odd", List.of("x", "red", "x"), List.of("red")).unknown());
    }
}

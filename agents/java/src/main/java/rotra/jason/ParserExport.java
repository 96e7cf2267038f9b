package rotra.jason;

import jason.JasonException;
import jason.asSemantics.Agent;
import jason.asSyntax.ArithExpr;
import jason.asSyntax.InternalActionLiteral;
import jason.asSyntax.ListTerm;
import jason.asSyntax.Literal;
import jason.asSyntax.LogExpr;
import jason.asSyntax.LogicalFormula;
import jason.asSyntax.NumberTerm;
import jason.asSyntax.Plan;
import jason.asSyntax.PlanBody;
import jason.asSyntax.RelExpr;
import jason.asSyntax.Rule;
import jason.asSyntax.SourceInfo;
import jason.asSyntax.StringTerm;
import jason.asSyntax.Term;
import jason.asSyntax.Trigger;
import jason.asSyntax.VarTerm;
import jason.asSyntax.parser.ParseException;
import jason.asSyntax.parser.TokenMgrError;
import jason.asSyntax.parser.as2j;
import java.io.IOException;
import java.io.Reader;
import java.io.StringReader;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.HashSet;
import java.util.List;
import java.util.Set;
import java.util.logging.Handler;
import java.util.logging.Level;
import java.util.logging.LogRecord;
import java.util.logging.Logger;
import java.util.regex.Matcher;
import java.util.regex.Pattern;
import javax.json.Json;
import javax.json.JsonArrayBuilder;
import javax.json.JsonObject;
import javax.json.JsonObjectBuilder;
import javax.json.JsonValue;

/**
 * What Jason's own parser reads in an AgentSpeak file, as JSON: what is checked is what runs.
 *
 * <p>In: a file, or the text of a formula.  Out: its AST with file and line, or where it is wrong.  Left to others: what of it
 * can be translated (the Python fragment check).
 */
final class ParserExport {

    /** The file cannot be read as AgentSpeak. */
    static final class Refused extends Exception {
        final String file;
        final int line;
        final int column;

        Refused(String file, int line, int column, String message) {
            super(message);
            this.file = file;
            this.line = line;
            this.column = column;
        }

        JsonObject toJson() {
            return Json.createObjectBuilder().add("file", file).add("line", line).add("column", column).add("message", String.valueOf(getMessage())).build();
        }
    }

    private static final Pattern INCLUDE = Pattern.compile("include\\s*\\(\\s*\"([^\"]*)\"");
    private static final Pattern URL = Pattern.compile("^[a-zA-Z][a-zA-Z0-9+.-]+:.*");
    private static final Pattern PLACE = Pattern.compile("\\[([^\\[\\]]*):(\\d+)\\]");
    private static final Pattern INCLUDED = Pattern.compile("error parsing \"(?:file:)?([^\"]*)\"");
    private static final Pattern LABEL_TWICE = Pattern.compile("already is a plan with label (\\w+)");
    private static final Pattern LEXICAL = Pattern.compile("line (\\d+), column (\\d+)");

    private ParserExport() { }

    // -- files ----------------------------------------------------------------------------------------------------------

    /** {"file", "ast"} or {"file", "error"}. */
    static JsonObject export(String file) {
        JsonObjectBuilder out = Json.createObjectBuilder().add("file", file);
        try {
            return out.add("ast", agent(file)).build();
        } catch (Refused refused) {
            return out.add("error", refused.toJson()).build();
        }
    }

    /** No file that is read, directly or by include, asks for something from the net or for a file that is not there. */
    static void checkIncludes(Path file, Set<Path> seen) throws Refused {
        if (!seen.add(file.toAbsolutePath().normalize())) {
            return;
        }
        List<String> lines;
        try {
            lines = Files.readAllLines(file, StandardCharsets.UTF_8);
        } catch (IOException e) {
            throw new Refused(file.toString(), 0, 0, "cannot read the file (missing, or not UTF-8)");
        }
        for (int i = 0; i < lines.size(); i++) {
            int comment = lines.get(i).indexOf("//");
            Matcher include = INCLUDE.matcher(lines.get(i));
            while (include.find()) {
                if (comment >= 0 && comment < include.start()) {
                    break;
                }
                String name = include.group(1);
                if (URL.matcher(name).matches()) {
                    throw new Refused(file.toString(), i + 1, 0, "an include from the net or from a jar is not read: " + name);
                }
                Path included = Includes.resolve(name, file);
                if (!name.startsWith("$") && Files.isRegularFile(included)) {
                    checkIncludes(included, seen);
                } else {
                    throw new Refused(file.toString(), i + 1, 0, "the included file is not there: " + name);
                }
            }
        }
    }

    private static JsonObject agent(String file) throws Refused {
        checkIncludes(Path.of(file), new HashSet<>());
        List<LogRecord> logged = new ArrayList<>();
        Agent agent = new Agent();
        agent.initAg();
        agent.setASLSrc(file);
        Handler handler = new Handler() {
            @Override
            public void publish(LogRecord entry) {
                logged.add(entry);
            }

            @Override
            public void flush() { }

            @Override
            public void close() { }
        };
        Logger includes = Logger.getLogger("jason.asSyntax.directives.Include");
        Logger parser = Logger.getLogger("aslparser");
        for (Logger logger : List.of(includes, parser)) {
            logger.setLevel(Level.WARNING);
            logger.setUseParentHandlers(false);
            logger.addHandler(handler);
        }
        try (Reader reader = Files.newBufferedReader(Path.of(file), StandardCharsets.UTF_8)) {
            as2j as = new as2j(reader);
            as.setASLSource(file);
            as.agent(agent);
        } catch (ParseException e) {
            throw refused(file, e);
        } catch (TokenMgrError e) {
            Matcher m = LEXICAL.matcher(String.valueOf(e.getMessage()));
            boolean found = m.find();
            throw new Refused(file, found ? Integer.parseInt(m.group(1)) : 0, found ? Integer.parseInt(m.group(2)) : 0, e.getMessage());
        } catch (JasonException | IOException | RuntimeException e) {
            throw refused(file, e);
        } finally {
            includes.removeHandler(handler);
            parser.removeHandler(handler);
        }
        JsonArrayBuilder warnings = Json.createArrayBuilder();
        for (LogRecord entry : logged) {
            String message = entry.getMessage() + (entry.getThrown() == null ? "" : " " + entry.getThrown().getMessage());
            if (entry.getLevel().intValue() >= Level.SEVERE.intValue()) {
                throw refused(file, new JasonException(message));
            }
            warnings.add(Json.createObjectBuilder().add("message", message));
        }
        return ast(agent, file, warnings);
    }

    private static Refused refused(String file, Exception e) {
        String message = e.getMessage() == null ? e.toString() : e.getMessage();
        if (e instanceof ParseException p && p.currentToken != null && p.currentToken.next != null) {
            return new Refused(file, p.currentToken.next.beginLine, p.currentToken.next.beginColumn, message);
        }
        Matcher twice = LABEL_TWICE.matcher(message);
        if (twice.find()) {
            return new Refused(file, lastLineOf(file, Pattern.compile("@" + twice.group(1) + "\\b")), 0, message);
        }
        Matcher included = INCLUDED.matcher(message);
        Matcher there = LEXICAL.matcher(message);
        if (included.find() && there.find()) {
            return new Refused(included.group(1), Integer.parseInt(there.group(1)), Integer.parseInt(there.group(2)), message.substring(included.end()).replaceFirst("^[: ]+", ""));
        }
        Matcher place = PLACE.matcher(message);
        if (place.find()) {
            return new Refused(place.group(1).isEmpty() ? file : place.group(1), Integer.parseInt(place.group(2)), 0, message);
        }
        Matcher line = LEXICAL.matcher(message);
        return line.find() ? new Refused(file, Integer.parseInt(line.group(1)), Integer.parseInt(line.group(2)), message) : new Refused(file, 0, 0, message);
    }

    /** The last line of a file that holds the pattern, as Jason does not say where it stands; 0 where none does. */
    private static int lastLineOf(String file, Pattern pattern) {
        int found = 0;
        try {
            List<String> lines = Files.readAllLines(Path.of(file), StandardCharsets.UTF_8);
            for (int i = 0; i < lines.size(); i++) {
                found = pattern.matcher(lines.get(i)).find() ? i + 1 : found;
            }
        } catch (IOException e) {
            return 0;
        }
        return found;
    }

    private static JsonObject ast(Agent agent, String file, JsonArrayBuilder warnings) {
        JsonArrayBuilder beliefs = Json.createArrayBuilder();
        JsonArrayBuilder rules = Json.createArrayBuilder();
        int index = 0;
        for (Literal belief : agent.getInitialBels()) {
            if (belief instanceof Rule rule) {
                JsonObjectBuilder out = place(Json.createObjectBuilder(), rule.getSrcInfo(), file);
                rules.add(out.add("head", literal(rule.headClone())).add("body", formula(rule.getBody())).add("index", index++));
            } else {
                beliefs.add(place(Json.createObjectBuilder(), belief.getSrcInfo(), file).add("literal", literal(belief)).add("index", index++));
            }
        }
        JsonArrayBuilder goals = Json.createArrayBuilder();
        for (Literal goal : agent.getInitialGoals()) {
            goals.add(place(Json.createObjectBuilder(), goal.getSrcInfo(), file).add("literal", literal(goal)));
        }
        JsonArrayBuilder plans = Json.createArrayBuilder();
        for (Plan plan : agent.getPL().getPlans()) {
            plans.add(plan(plan, file));
        }
        return Json.createObjectBuilder().add("beliefs", beliefs).add("rules", rules).add("goals", goals).add("plans", plans).add("warnings", warnings).build();
    }

    private static JsonObject plan(Plan plan, String file) {
        Trigger trigger = plan.getTrigger();
        String label = plan.getLabel() == null || plan.getLabel().getFunctor().startsWith("p__") ? "" : plan.getLabel().getFunctor();
        JsonArrayBuilder annotations = Json.createArrayBuilder();
        if (plan.getLabel() != null && plan.getLabel().hasAnnot()) {
            for (Term annotation : plan.getLabel().getAnnots()) {
                if (!(annotation instanceof Literal l && (l.getFunctor().equals("source") || l.getFunctor().equals("url")))) {
                    annotations.add(term(annotation));
                }
            }
        }
        SourceInfo source = trigger.getLiteral().getSrcInfo() != null ? trigger.getLiteral().getSrcInfo() : plan.getSrcInfo();
        JsonObjectBuilder out = place(Json.createObjectBuilder(), source, file).add("label", label).add("annotations", annotations);
        out.add("trigger", place(Json.createObjectBuilder(), source, file).add("op", trigger.getOperator().toString().trim())
                .add("type", trigger.getType().name()).add("literal", literal(trigger.getLiteral())));
        out.add("context", plan.getContext() == null ? JsonValue.NULL : formula(plan.getContext())).add("body", body(plan.getBody(), file));
        if (plan.hasGoalCondition() || plan.hasSubPlans()) {
            out.add("extended", true);
        }
        return out.build();
    }

    private static JsonObjectBuilder place(JsonObjectBuilder out, SourceInfo source, String file) {
        boolean known = source != null && source.getSrcFile() != null;
        return out.add("file", known ? source.getSrcFile() : file).add("line", source == null ? 0 : source.getBeginSrcLine());
    }

    // -- formulas -------------------------------------------------------------------------------------------------------

    /** {"id", "ast"} or {"id", "error"}. */
    static JsonObject formula(JsonObject job) {
        String file = job.getString("file", "");
        int line = job.getInt("line", 0);
        JsonObjectBuilder out = Json.createObjectBuilder().add("id", job.get("id"));
        try {
            as2j as = new as2j(new StringReader(job.getString("text")));
            as.setASLSource(file);
            LogicalFormula read = (LogicalFormula) as.log_expr();
            if (as.getNextToken().kind != 0) {
                throw new ParseException("something is left over after the formula");
            }
            return out.add("ast", formula(read)).build();
        } catch (ParseException | TokenMgrError | RuntimeException e) {
            return out.add("error", new Refused(file, line, 0, String.valueOf(e.getMessage())).toJson()).build();
        }
    }

    static JsonObject formula(LogicalFormula formula) {
        JsonObjectBuilder out = Json.createObjectBuilder();
        if (formula.getSrcInfo() != null) {
            out.add("line", formula.getSrcInfo().getBeginSrcLine());
        }
        if (formula instanceof VarTerm v) {
            return out.add("f", "lit").add("literal", term(v)).build();
        }
        if (formula instanceof LogExpr e) {
            switch (e.getOp()) {
                case not:
                    return out.add("f", "not").add("arg", formula(e.getLHS())).build();
                case and:
                case or:
                    return out.add("f", e.getOp().name()).add("args", Json.createArrayBuilder().add(formula(e.getLHS())).add(formula(e.getRHS()))).build();
                default:
                    return formula(e.getLHS());
            }
        }
        if (formula instanceof RelExpr e) {
            return out.add("f", "rel").add("op", e.getOp().toString().trim()).add("left", term(e.getTerm(0))).add("right", term(e.getTerm(1))).build();
        }
        if (formula instanceof Literal l) {
            if (l instanceof InternalActionLiteral || l.isInternalAction()) {
                return out.add("f", "internal").add("name", l.getFunctor()).add("args", terms(l)).build();
            }
            if (l.getArity() == 0 && (l.getFunctor().equals("true") || l.getFunctor().equals("false")) && !l.negated()) {
                return out.add("f", l.getFunctor()).build();
            }
            return out.add("f", "lit").add("literal", literal(l)).build();
        }
        return out.add("f", "lit").add("literal", term((Term) formula)).build();
    }

    // -- terms ----------------------------------------------------------------------------------------------------------

    private static JsonArrayBuilder terms(Literal literal) {
        JsonArrayBuilder out = Json.createArrayBuilder();
        for (int i = 0; i < literal.getArity(); i++) {
            out.add(term(literal.getTerm(i)));
        }
        return out;
    }

    /** A belief, goal or act: always a struct. */
    static JsonObject literal(Literal l) {
        if (l instanceof VarTerm) {
            return term(l);
        }
        JsonArrayBuilder annotations = Json.createArrayBuilder();
        if (l.hasAnnot()) {
            for (Term annotation : l.getAnnots()) {
                annotations.add(term(annotation));
            }
        }
        JsonObjectBuilder out = Json.createObjectBuilder().add("t", "struct").add("name", l.getFunctor()).add("args", terms(l)).add("neg", l.negated()).add("annots", annotations);
        if (l.getNS() == Literal.DefaultNS) {
            out.addNull("ns");
        } else {
            out.add("ns", l.getNS().toString());
        }
        return out.build();
    }

    static JsonObject term(Term t) {
        JsonObjectBuilder out = Json.createObjectBuilder();
        if (t instanceof VarTerm v) {
            JsonArrayBuilder annotations = Json.createArrayBuilder();
            if (v.hasAnnot()) {
                v.getAnnots().forEach(annotation -> annotations.add(term(annotation)));
            }
            return out.add("t", "var").add("name", v.getFunctor()).add("neg", v.negated()).add("annots", annotations).build();
        }
        if (t instanceof Plan) {
            return out.add("t", "formula").add("formula", Json.createObjectBuilder().add("f", "plan").add("text", t.toString())).build();
        }
        if (t instanceof PlanBody b) {
            return out.add("t", "body").add("body", body(b, "")).build();
        }
        if (t instanceof LogExpr || t instanceof RelExpr) {
            return out.add("t", "formula").add("formula", formula((LogicalFormula) t)).build();
        }
        if (t instanceof ArithExpr e) {
            JsonArrayBuilder args = Json.createArrayBuilder().add(term(e.getTerm(0)));
            if (!e.isUnary()) {
                args.add(term(e.getTerm(1)));
            }
            return out.add("t", "arith").add("op", e.getOp().toString().trim()).add("args", args).build();
        }
        if (t instanceof NumberTerm n) {
            try {
                double value = n.solve();
                return value == Math.rint(value) && Math.abs(value) < 1e15 ? out.add("t", "int").add("value", (long) value).build() : out.add("t", "real").add("value", value).build();
            } catch (Exception e) {
                return out.add("t", "arith").add("op", t.toString()).add("args", t instanceof Literal l ? terms(l) : Json.createArrayBuilder()).build();
            }
        }
        if (t instanceof StringTerm s) {
            return out.add("t", "string").add("value", s.getString()).build();
        }
        if (t instanceof ListTerm l) {
            JsonArrayBuilder items = Json.createArrayBuilder();
            for (Term item : l.getAsList()) {
                items.add(term(item));
            }
            Term tail = l.getTail();
            out.add("t", "list").add("items", items);
            return (tail != null && tail.isVar() ? out.add("tail", term(tail)) : out.addNull("tail")).build();
        }
        if (t instanceof Literal l) {
            if (l.isInternalAction()) {
                return out.add("t", "formula").add("formula", formula((LogicalFormula) l)).build();
            }
            return l.getArity() == 0 && !l.hasAnnot() && !l.negated() ? out.add("t", "atom").add("name", l.getFunctor()).build() : literal(l);
        }
        return out.add("t", "atom").add("name", t.toString()).build();
    }

    // -- bodies ---------------------------------------------------------------------------------------------------------

    private static JsonArrayBuilder body(PlanBody first, String file) {
        JsonArrayBuilder out = Json.createArrayBuilder();
        for (PlanBody step = first; step != null && !step.isEmptyBody(); step = step.getBodyNext()) {
            SourceInfo source = step.getSrcInfo() != null ? step.getSrcInfo() : step.getBodyTerm().getSrcInfo();
            out.add(step(step, place(Json.createObjectBuilder(), source, file), file));
        }
        return out;
    }

    private static JsonObjectBuilder step(PlanBody step, JsonObjectBuilder out, String file) {
        Term t = step.getBodyTerm();
        return switch (step.getBodyType()) {
            case action -> out.add("b", "action").add("literal", any(t));
            case internalAction -> internal((Literal) t, out, file);
            case achieve -> out.add("b", "achieve").add("literal", any(t));
            case achieveNF -> out.add("b", "achieve_new").add("literal", any(t));
            case test -> out.add("b", "test").add("formula", formula((LogicalFormula) t));
            case constraint -> out.add("b", "constraint").add("formula", formula((LogicalFormula) t));
            case addBel, addBelBegin -> out.add("b", "add").add("literal", any(t));
            case addBelEnd -> out.add("b", "add_end").add("literal", any(t));
            case addBelNewFocus -> out.add("b", "add_new").add("literal", any(t));
            case delBel -> out.add("b", "del").add("literal", any(t));
            case delBelNewFocus -> out.add("b", "del_new").add("literal", any(t));
            case delAddBel -> out.add("b", "update").add("literal", any(t));
            default -> out.add("b", step.getBodyType().name()).add("text", t.toString());
        };
    }

    private static JsonObject any(Term t) {
        return t instanceof Literal l && !(t instanceof VarTerm) ? literal(l) : term(t);
    }

    private static JsonObjectBuilder internal(Literal l, JsonObjectBuilder out, String file) {
        switch (l.getFunctor()) {
            case ".if_then_else":
                JsonArrayBuilder branches = Json.createArrayBuilder();
                JsonValue last = JsonValue.NULL;
                // else-if arrives as an else that holds one .if_then_else: left nested, it means the same
                branches.add(Json.createObjectBuilder().add("cond", formula((LogicalFormula) l.getTerm(0))).add("body", body((PlanBody) l.getTerm(1), file)));
                if (l.getArity() > 2) {
                    last = body((PlanBody) l.getTerm(2), file).build();
                }
                return out.add("b", "if").add("branches", branches).add("else", last);
            case ".foreach":
                return out.add("b", "for").add("name", l.getFunctor()).add("args", terms(l));
            case ".loop":
                return out.add("b", "while").add("name", l.getFunctor()).add("args", terms(l));
            case ".fork":
                return out.add("b", "fork").add("name", l.getFunctor()).add("args", terms(l));
            default:
                return out.add("b", "internal").add("name", l.getFunctor()).add("args", terms(l));
        }
    }
}

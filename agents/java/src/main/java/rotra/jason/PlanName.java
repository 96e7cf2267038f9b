package rotra.jason;

import jason.asSyntax.Plan;
import jason.asSyntax.SourceInfo;
import javax.json.Json;
import javax.json.JsonObject;

/** How a trace names a plan: its label (empty where Jason made one up), and the file and line of its trigger. */
final class PlanName {

    private static final String MADE_UP = "p__";

    private PlanName() { }

    static JsonObject of(Plan plan) {
        SourceInfo trigger = plan.getTrigger().getLiteral().getSrcInfo();
        SourceInfo source = trigger != null ? trigger : plan.getSrcInfo();
        String file = source == null || source.getSrcFile() == null ? "" : source.getSrcFile();
        return Json.createObjectBuilder().add("label", label(plan)).add("file", file).add("line", source == null ? 0 : source.getBeginSrcLine()).build();
    }

    static String label(Plan plan) {
        String label = plan.getLabel() == null ? "" : plan.getLabel().getFunctor();
        return label.startsWith(MADE_UP) ? "" : label;
    }
}

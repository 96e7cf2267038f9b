package rotra.jason;

import jason.util.Config;
import java.util.logging.Level;
import java.util.logging.Logger;

/** Keeps Jason from opening ports and from logging; to be called before any other Jason class is touched. */
final class Quiet {

    /** Held, because the log manager forgets the level of a logger that nobody holds. */
    private static final Logger[] LOGGERS = {Logger.getLogger("jason"), Logger.getLogger("aslparser"), Logger.getLogger("")};

    private Quiet() { }

    static void please() {
        Config.get().setProperty(Config.START_WEB_MI, "false");
        Config.get().setShowFixMsgs(false);
        for (Logger logger : LOGGERS) {
            logger.setLevel(Level.OFF);
        }
    }
}

package rotra.advice;

/** What a rule asks for: {@code must stop_at_white_line}. */
public record Directive(String label, String action) { }

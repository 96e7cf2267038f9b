"""Evidence that shares no code with the translator: what is here reads files, and nothing from lowering/ or emitters/."""

"""See the files here: each says what goes in and what comes out."""

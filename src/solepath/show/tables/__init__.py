"""Tables, figures in words and the live terminal for people; nothing is computed here."""

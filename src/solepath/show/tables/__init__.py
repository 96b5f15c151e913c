"""What people look at: tables, figures in words, the live terminal. Nothing is computed here."""

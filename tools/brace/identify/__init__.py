"""Parameters from measurements: fitted as far as the data can show them, with a list of what the data cannot show."""

# Placeholder until the install rules are written.

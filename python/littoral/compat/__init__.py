"""Modules with the names and arguments of other packages: one import changes, the rest stays."""

"""Drawn mutants that no test can kill: {(header, the changed line -> what it becomes): why}. They do not count."""

EQUIVALENT = {
}

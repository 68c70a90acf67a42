# The one version of all that is released together. docs/versions.md says what may change when.
set(BRACE_VERSION 0.1.0)

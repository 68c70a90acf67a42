"""Diagnosis of a loading record, a file a step: noise, base, search, structure, choice, experiment."""

from brace.diagnose.loading.run import diagnose_loading

__all__ = ["diagnose_loading"]

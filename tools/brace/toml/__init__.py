"""TOML documents that know the line of every key, checked against a table of allowed keys."""

from brace.toml.document import Document, parse, read
from brace.toml.schema import Key, Value, check, number, whole

__all__ = ["Document", "Key", "Value", "check", "number", "parse", "read", "whole"]

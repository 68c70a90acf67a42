"""The parser of TOML: Python's own from 3.11 on, and the same code as a package for Python 3.10."""

import sys

if sys.version_info >= (3, 11):
    import tomllib  # noqa: TID251
else:
    import tomli as tomllib

__all__ = ["tomllib"]

"""What cffi hands over from C. cffi has no types for what a header declares, so this is the one place to say Any."""

from typing import Any, TypeAlias

CData: TypeAlias = Any

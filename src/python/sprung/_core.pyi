"""The compiled part; __init__.pyi has the types of what programs use."""
from typing import Any

def __getattr__(name: str) -> Any: ...

"""Files of the user's own, in the folder that the platform keeps for such."""

from __future__ import annotations

import os
import sys
from pathlib import Path

APPLICATION = "elemental"


def config_folder() -> Path:
    """Where settings of the program itself are kept; it need not exist yet.

    XDG_CONFIG_HOME or ~/.config, on macOS ~/Library/Application Support, on Windows APPDATA.
    """
    if sys.platform == "win32":
        base = os.environ.get("APPDATA") or str(Path.home() / "AppData" / "Roaming")
    elif sys.platform == "darwin":
        base = str(Path.home() / "Library" / "Application Support")
    else:
        base = os.environ.get("XDG_CONFIG_HOME") or str(Path.home() / ".config")
    return Path(base) / APPLICATION

"""Every tunable of the program, once: name, unit, range, default, meaning and source.

The command line (``--set gi.resolution=256``), scene files (``[settings]``, ``[[volumes]]``),
``elemental list settings`` and the passes all read the one table ``SETTINGS``. Values are checked
when a ``Settings`` is made, so a pass never meets a value outside its range.
"""

from elemental.settings.setting import Setting
from elemental.settings.values import SETTINGS, Mix, Settings, check_override, check_setting

__all__ = ["SETTINGS", "Mix", "Setting", "Settings", "check_override", "check_setting"]

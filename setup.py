"""What pyproject.toml can't say: the wheel carries glsl/ and content/ inside the package.

`elemental.core.paths` finds them beside app/ in a checkout and inside the package when installed.
"""

from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

DATA_FOLDERS = ("glsl", "content")


class BuildWithData(build_py):
    """Copies the data folders into the package; an editable install leaves them where they are."""

    def _data(self) -> list[tuple[str, str]]:
        """(source, target) of every data file."""
        target = Path(self.build_lib) / "elemental"
        return [
            (str(file), str(target / file))
            for folder in DATA_FOLDERS
            for file in sorted(Path(folder).rglob("*"))
            if file.is_file()
        ]

    def run(self) -> None:
        """Build the modules, then the data."""
        super().run()
        if self.editable_mode:
            return
        for source, target in self._data():
            self.mkpath(str(Path(target).parent))
            self.copy_file(source, target)

    def get_outputs(self, include_bytecode: bool = True) -> list[str]:
        """Every file that run() writes."""
        outputs: list[str] = super().get_outputs(include_bytecode)
        return outputs if self.editable_mode else outputs + [target for _, target in self._data()]


setup(cmdclass={"build_py": BuildWithData})

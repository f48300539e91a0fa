"""Run the commands of docs/get-started/first-car.md with the `kintrafo` on the path."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

PAGE = (Path(__file__).parent.parent / "docs/get-started/first-car.md").read_text(encoding="utf-8")


def main(folder: Path) -> None:
    """Run the commands of the page in a folder, with its change of the file."""
    if shutil.which("cc") or shutil.which("gcc"):
        sys.exit("there is a compiler on the path")
    (changed,) = re.findall(r"```toml\n(.*?)\n```", PAGE, flags=re.DOTALL)
    for block in re.findall(r"```sh\n(.*?)```", PAGE, flags=re.DOTALL):
        for line in block.splitlines():
            command = shlex.split(line, comments=True)
            if command[0] == "cp":  # only `kintrafo` is on the path
                text = (folder / command[1]).read_text(encoding="utf-8")
                text = re.sub(r"^tie_rod_inner = .*$", changed, text, flags=re.MULTILINE)
                (folder / command[2]).write_text(text, encoding="utf-8")
                continue
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)  # noqa: S603 (this project's page)
            print("ok     " if done.returncode == 0 else "FAILED ", line)
            if done.returncode:
                sys.exit(done.stdout + done.stderr)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

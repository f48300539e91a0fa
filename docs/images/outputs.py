"""Draw the pictures of commands on their pages: ``python docs/images/outputs.py``.

Each is the picture of a command that the page names, with the files of that page.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from kintrafo.vehicle import cli
from PIL import Image
from typer.testing import CliRunner

_COLOURS = 64  # of a picture, which makes its file small
HERE = Path(__file__).parent
LOWER = ("tie_rod_inner = [-140.0, -310.0, 280.0]", "tie_rod_inner = [-140.0, -310.0, 272.0]")
# Commands, but for the path of the picture that they write.
PICTURES = {
    "compare": "compare {car} {lower} --of toe,bump_steer,camber",
    "rig": "compare {rig} {car}",
    "simulate": "simulate {car} --road-step 20 --road-step-at 0.1",
    "sweep": "sweep {car} strut.damper_rate_N_s_per_m=500:3000:11 --road-step 20",
    "ride": "ride quarter_car --bump-height 20 --bump-length 1 --speed 30 --duration 3",
    "axle_roll": "characteristics reference_axle --over roll",
    "car_roll": "characteristics reference_vehicle --over roll --of camber,toe,roll_center_height",
}


def main() -> None:
    """Write the pictures."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        names = {"car": "my_car.toml", "lower": "lower_rod.toml", "rig": "rig.csv"}
        files = {key: folder / name for key, name in names.items()}
        _run(["new", str(files["car"])])
        text = files["car"].read_text(encoding="utf-8")
        assert LOWER[0] in text
        files["lower"].write_text(text.replace(*LOWER), encoding="utf-8")
        page = (HERE.parent / "suspension/comparison.md").read_text(encoding="utf-8")
        files["rig"].write_text(page.partition("```csv\n")[2].partition("```")[0], encoding="utf-8")
        for picture, command in PICTURES.items():
            arguments = command.format(**files).split()
            _run([*arguments, "--plot", str(folder / "picture.png"), "--force"])
            (written,) = folder.glob("picture*.png")
            small = Image.open(written).convert("RGB").quantize(_COLOURS)
            small.save(HERE / f"{picture}.png", optimize=True)
            written.unlink()


def _run(arguments: list[str]) -> None:
    result = CliRunner().invoke(cli.app, arguments)
    assert result.exit_code == 0, result.output


if __name__ == "__main__":
    main()

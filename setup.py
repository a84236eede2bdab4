"""For catkin and for pip: package.xml says what this is, requirements.txt what it needs."""

from glob import glob
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

manifest = ElementTree.parse("package.xml")

setup(
    name=manifest.findtext("name"),
    version=manifest.findtext("version"),
    description=manifest.findtext("description"),
    license=manifest.findtext("license"),
    packages=find_packages("src"),
    package_dir={"": "src"},
    data_files=[
        (f"share/youbot_kinematics/{folder}", sorted(glob(f"{folder}/*")))
        for folder in ("bags", "config", "launch", "page", "urdf")
    ],
    install_requires=Path("requirements.txt").read_text().splitlines(),
    extras_require={
        "plot": ["matplotlib>=3.6"],
        "report": ["plotly", "urdf-parser-py"],
        "kdl": ["urdf-parser-py"],  # and PyKDL, which no wheel has: Debian's python3-pykdl
    },
    python_requires=">=3.8",
)

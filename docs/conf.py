"""How Sphinx builds the documents: ./run docs. Nothing is fetched, neither now nor by a reader."""

from pathlib import Path
from xml.etree import ElementTree

from latex2mathml.converter import convert

from youbot_kinematics import interface

ROOT = Path(__file__).resolve().parents[1]
manifest = ElementTree.parse(ROOT / "package.xml")

project = manifest.findtext("name")
release = manifest.findtext("version")
author = manifest.findtext("author")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
html_theme = "furo"
html_title = project
html_show_copyright = False
html_static_path = ["static"]
html_css_files = ["wide.css"]

myst_enable_extensions = ["dollarmath", "substitution"]
myst_heading_anchors = 3
# The tables come from what the node reads.
myst_substitutions = {
    "parameters": interface.parameter_table(),
    "simulator_parameters": interface.parameter_table(interface.SimulatorParameters),
    "trail_parameters": interface.parameter_table(interface.TrailParameters),
    "slider_parameters": interface.parameter_table(interface.SliderParameters),
    "channels": interface.channel_table(),
}

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_google_docstring = True
nitpicky = False


def setup(app):
    """Formulas as MathML, which browsers draw by themselves."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))


def _inline(self, node):
    self.body.append(convert(node.astext()))
    _skip()


def _block(self, node):
    self.body.append(f"<p>{convert(node.astext(), display='block')}</p>")
    _skip()


def _skip():
    from docutils.nodes import SkipNode

    raise SkipNode


html_math_renderer = "mathml"

"""gcxform: read a G-code program, change what must change, write a program that is proved right.

What is named here is the public API for users and plugin authors, and nothing else is public. The
names are loaded when they are first used, so that `gcxform --help` need not wait for numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gcxform.api import Program as Program
    from gcxform.api import read as read
    from gcxform.api import write as write
    from gcxform.comparison import Comparison as Comparison
    from gcxform.comparison import Difference as Difference
    from gcxform.comparison import compare as compare
    from gcxform.config.toml_text import did_you_mean as did_you_mean
    from gcxform.config.toml_text import read_text as read_text
    from gcxform.contract.demands import Demands as Demands
    from gcxform.contract.options import Angle as Angle
    from gcxform.contract.options import KinematicsFile as KinematicsFile
    from gcxform.contract.options import Length as Length
    from gcxform.contract.options import Lines as Lines
    from gcxform.contract.options import ModelFile as ModelFile
    from gcxform.contract.options import Option as Option
    from gcxform.contract.options import Vector as Vector
    from gcxform.contract.passes import CompensationPass as CompensationPass
    from gcxform.contract.passes import Pass as Pass
    from gcxform.contract.passes import PassContext as PassContext
    from gcxform.contract.passes import TextPass as TextPass
    from gcxform.deviations.deviation import deviation as deviation
    from gcxform.diagnostics import Diagnostic as Diagnostic
    from gcxform.diagnostics import FileError as FileError
    from gcxform.diagnostics import GcxformError as GcxformError
    from gcxform.diagnostics import InputError as InputError
    from gcxform.diagnostics import Location as Location
    from gcxform.diagnostics import UsageError as UsageError
    from gcxform.diagnostics import VerificationError as VerificationError
    from gcxform.dialect.codes import Code as Code
    from gcxform.dialect.codes import CutterComp as CutterComp
    from gcxform.dialect.codes import MCode as MCode
    from gcxform.dialect.dialect import Dialect as Dialect
    from gcxform.dialect.dialect import NumberFormat as NumberFormat
    from gcxform.dialect.frame_rules import OffsetRule as OffsetRule
    from gcxform.dialect.frame_rules import TipRule as TipRule
    from gcxform.dialect.frame_rules import ToolRule as ToolRule
    from gcxform.dialect.increments import PointRule as PointRule
    from gcxform.dialect.move_rules import ArcRule as ArcRule
    from gcxform.dialect.move_rules import FeedRule as FeedRule
    from gcxform.dialect.move_rules import MotionRule as MotionRule
    from gcxform.dialect.program_rules import BlockRule as BlockRule
    from gcxform.dialect.program_rules import FlowRule as FlowRule
    from gcxform.dialect.program_rules import LookupRule as LookupRule
    from gcxform.dialect.program_rules import ProgramRule as ProgramRule
    from gcxform.dialect.program_rules import TextRule as TextRule
    from gcxform.errormodel.converting import Fit as Fit
    from gcxform.errormodel.converting import to_functions as to_functions
    from gcxform.errormodel.converting import to_lattice as to_lattice
    from gcxform.errormodel.converting import to_nine as to_nine
    from gcxform.errormodel.converting import to_pitch as to_pitch
    from gcxform.errormodel.formats import ErrorFormat as ErrorFormat
    from gcxform.errormodel.formats import cannot_hold as cannot_hold
    from gcxform.errormodel.formats import head_of as head_of
    from gcxform.errormodel.functions import AxisFunction as AxisFunction
    from gcxform.errormodel.functions import AxisFunctions as AxisFunctions
    from gcxform.errormodel.functions import Fault as Fault
    from gcxform.errormodel.functions import faults as faults
    from gcxform.errormodel.lattice import Lattice as Lattice
    from gcxform.errormodel.linear import Linear as Linear
    from gcxform.errormodel.mean import Mean as Mean
    from gcxform.errormodel.model import ErrorModel as ErrorModel
    from gcxform.errormodel.model import Outside as Outside
    from gcxform.errormodel.model import check_contraction as check_contraction
    from gcxform.errormodel.model import compensate as compensate
    from gcxform.errormodel.model import reach_of as reach_of
    from gcxform.errormodel.pitch import PitchTable as PitchTable
    from gcxform.errormodel.pitch import PitchTables as PitchTables
    from gcxform.errormodel.rigid import RigidBody as RigidBody
    from gcxform.errormodel.sum import Sum as Sum
    from gcxform.errormodel.text_tables import TextRow as TextRow
    from gcxform.errormodel.text_tables import decimal as decimal
    from gcxform.errormodel.text_tables import number_findings as number_findings
    from gcxform.errormodel.text_tables import placed as placed
    from gcxform.errormodel.text_tables import text_rows as text_rows
    from gcxform.flow.translation import Item as Item
    from gcxform.flow.translation import Translator as Translator
    from gcxform.guess import Evidence as Evidence
    from gcxform.guess import Guess as Guess
    from gcxform.guess import guess_dialect as guess_dialect
    from gcxform.machine.chain import Chain as Chain
    from gcxform.machine.chain import Rotary as Rotary
    from gcxform.machine.chain import chain_of as chain_of
    from gcxform.machine.control import Setting as Setting
    from gcxform.machine.formats import ControlFiles as ControlFiles
    from gcxform.machine.inverse import Attitudes as Attitudes
    from gcxform.machine.inverse import Poses as Poses
    from gcxform.machine.inverse import State as State
    from gcxform.machine.inverse import attitudes as attitudes
    from gcxform.machine.inverse import inverse as inverse
    from gcxform.machine.inverse import turns as turns
    from gcxform.machine.kinds import Kinematics as Kinematics
    from gcxform.pipeline.pipeline import Pipeline as Pipeline
    from gcxform.pipeline.pipeline import Result as Result
    from gcxform.plugin.hookspecs import hookimpl as hookimpl
    from gcxform.plugin.registry import Registry as Registry
    from gcxform.syntax.tree import Block as Block
    from gcxform.syntax.tree import Comment as Comment
    from gcxform.syntax.tree import Number as Number
    from gcxform.syntax.tree import Word as Word
    from gcxform.system.limits import Limits as Limits
    from gcxform.toolpath.circles import arc_cuts as arc_cuts
    from gcxform.toolpath.circles import arc_extremes as arc_extremes
    from gcxform.toolpath.circles import circle_through as circle_through
    from gcxform.toolpath.circles import points_on_arcs as points_on_arcs
    from gcxform.toolpath.circles import radius_and_angle as radius_and_angle
    from gcxform.toolpath.circles import swept_anew as swept_anew
    from gcxform.toolpath.columns import column_major as column_major
    from gcxform.toolpath.crossings import line_crossings as line_crossings
    from gcxform.toolpath.facts import ABSOLUTE as ABSOLUTE
    from gcxform.toolpath.facts import AXIS_POSITIONS as AXIS_POSITIONS
    from gcxform.toolpath.facts import COMPENSATED as COMPENSATED
    from gcxform.toolpath.facts import KNOWN_POSITIONS as KNOWN_POSITIONS
    from gcxform.toolpath.facts import LINEAR_ONLY as LINEAR_ONLY
    from gcxform.toolpath.facts import METRIC as METRIC
    from gcxform.toolpath.facts import NO_CUTTER_COMP as NO_CUTTER_COMP
    from gcxform.toolpath.facts import NO_CYCLES as NO_CYCLES
    from gcxform.toolpath.facts import NOMINAL as NOMINAL
    from gcxform.toolpath.facts import TIP_POSITIONS as TIP_POSITIONS
    from gcxform.toolpath.facts import WORKPIECE_FRAME as WORKPIECE_FRAME
    from gcxform.toolpath.facts import XY_ARCS as XY_ARCS
    from gcxform.toolpath.facts import Fact as Fact
    from gcxform.toolpath.facts import inseparable_cycles as inseparable_cycles
    from gcxform.toolpath.frames import Frame as Frame
    from gcxform.toolpath.path import FREE as FREE
    from gcxform.toolpath.path import OWN_DISTANCES as OWN_DISTANCES
    from gcxform.toolpath.path import Blocks as Blocks
    from gcxform.toolpath.path import Event as Event
    from gcxform.toolpath.path import FeedMode as FeedMode
    from gcxform.toolpath.path import Form as Form
    from gcxform.toolpath.path import Given as Given
    from gcxform.toolpath.path import Kind as Kind
    from gcxform.toolpath.path import Plane as Plane
    from gcxform.toolpath.path import Toolpath as Toolpath
    from gcxform.toolpath.splines import points_on_splines as points_on_splines
    from gcxform.toolpath.splines import spline_chords as spline_chords
    from gcxform.toolpath.splines import splines_as_lines as splines_as_lines

_HOMES = {
    "api": "Program read write",
    "comparison": "Comparison Difference compare",
    "contract.demands": "Demands",
    "contract.passes": "CompensationPass Pass PassContext TextPass",
    "diagnostics": "Diagnostic FileError GcxformError InputError Location UsageError "
    "VerificationError",
    "dialect.dialect": "Dialect NumberFormat",
    "dialect.frame_rules": "OffsetRule TipRule ToolRule",
    "dialect.increments": "PointRule",
    "dialect.move_rules": "ArcRule FeedRule MotionRule",
    "dialect.program_rules": "BlockRule FlowRule LookupRule ProgramRule TextRule",
    "flow.translation": "Item Translator",
    "guess": "Evidence Guess guess_dialect",
    "plugin.hookspecs": "hookimpl",
    "system.limits": "Limits",
    "machine.chain": "Chain Rotary chain_of",
    "machine.inverse": "Attitudes Poses State attitudes inverse turns",
    "errormodel.model": "ErrorModel Outside check_contraction compensate reach_of",
    "machine.control": "Setting",
    "machine.formats": "ControlFiles",
    "errormodel.converting": "Fit to_functions to_lattice to_nine to_pitch",
    "errormodel.functions": "AxisFunction AxisFunctions Fault faults",
    "errormodel.lattice": "Lattice",
    "errormodel.linear": "Linear",
    "errormodel.mean": "Mean",
    "machine.kinds": "Kinematics",
    "errormodel.rigid": "RigidBody",
    "errormodel.pitch": "PitchTable PitchTables",
    "errormodel.sum": "Sum",
    "errormodel.text_tables": "TextRow decimal number_findings placed text_rows",
    "config.toml_text": "did_you_mean read_text",
    "errormodel.formats": "ErrorFormat cannot_hold head_of",
    "dialect.codes": "Code CutterComp MCode",
    "contract.options": "Angle KinematicsFile Length Lines ModelFile Option Vector",
    "pipeline.pipeline": "Pipeline Result",
    "plugin.registry": "Registry",
    "syntax.tree": "Block Comment Number Word",
    "toolpath.columns": "column_major",
    "toolpath.circles": "arc_cuts arc_extremes circle_through points_on_arcs radius_and_angle "
    "swept_anew",
    "toolpath.crossings": "line_crossings",
    "deviations.deviation": "deviation",
    "toolpath.facts": "ABSOLUTE AXIS_POSITIONS COMPENSATED KNOWN_POSITIONS LINEAR_ONLY METRIC "
    "NO_CUTTER_COMP NO_CYCLES NOMINAL TIP_POSITIONS WORKPIECE_FRAME XY_ARCS Fact "
    "inseparable_cycles",
    "toolpath.frames": "Frame",
    "toolpath.path": "Blocks Event FREE FeedMode Form Given Kind OWN_DISTANCES Plane Toolpath",
    "toolpath.splines": "points_on_splines spline_chords splines_as_lines",
}
_HOME = {name: module for module, names in _HOMES.items() for name in names.split()}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'gcxform' has no attribute {name!r}")
    value = getattr(import_module(f"gcxform.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__

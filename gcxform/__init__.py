"""gcxform: read a G-code program, change what must change, write a program that is proved right."""

from gcxform.dialect import ArcRule, Dialect, NumberFormat
from gcxform.modal.codes import Code, MCode
from gcxform.toolpath.path import Kind, Plane, Toolpath

__all__ = ["ArcRule", "Code", "Dialect", "Kind", "MCode", "NumberFormat", "Plane", "Toolpath"]

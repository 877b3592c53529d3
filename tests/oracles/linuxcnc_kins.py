"""LinuxCNC's own kinematics, as installed: its realtime modules, loaded without LinuxCNC.

A module needs the functions of HAL. They are given by a small library which is compiled here: its
pins are numbers that are set and read by name.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest

MODULES = Path("/usr/lib/linuxcnc/modules")
JOINTS = 16
HAL = r"""
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct { char name[64]; void *value; } pins[256];
static int count;

static int pin(const char *name, void **at)
{
    if (count == 256) return -1;
    *at = calloc(1, 16);
    snprintf(pins[count].name, sizeof pins[count].name, "%s", name);
    pins[count++].value = *at;
    return 0;
}
static int vpin(void **at, const char *format, va_list arguments)
{
    char name[64];
    vsnprintf(name, sizeof name, format, arguments);
    return pin(name, at);
}
void *pin_value(const char *name)
{
    for (int k = 0; k < count; k++)
        if (!strcmp(pins[k].name, name)) return pins[k].value;
    return 0;
}
const char *pin_name(int k) { return k < count ? pins[k].name : 0; }
int hal_init(const char *name) { return 1; }
int hal_exit(int id) { return 0; }
int hal_ready(int id) { return 0; }
int hal_set_unready(int id) { return 0; }
void *hal_malloc(long size) { return calloc(1, size); }
int hal_pin_float_newf(int way, double **at, int id, const char *format, ...)
{
    va_list a; va_start(a, format); int r = vpin((void **)at, format, a); va_end(a); return r;
}
int hal_pin_s32_newf(int way, int **at, int id, const char *format, ...)
{
    va_list a; va_start(a, format); int r = vpin((void **)at, format, a); va_end(a); return r;
}
int hal_pin_bit_newf(int way, void **at, int id, const char *format, ...)
{
    va_list a; va_start(a, format); int r = vpin(at, format, a); va_end(a); return r;
}
int hal_pin_float_new(const char *name, int way, void **at, int id) { return pin(name, at); }
int hal_pin_bit_new(const char *name, int way, void **at, int id) { return pin(name, at); }
int hal_pin_s32_new(const char *name, int way, void **at, int id) { return pin(name, at); }
void rtapi_print(const char *format, ...) {}
void rtapi_print_msg(int level, const char *format, ...) {}
int rtapi_snprintf(char *to, unsigned long size, const char *format, ...)
{
    va_list a; va_start(a, format); int r = vsnprintf(to, size, format, a); va_end(a); return r;
}
"""


@cache
def _hal():
    """Return the library of HAL's functions; skip where it cannot be compiled."""
    if not shutil.which("gcc"):
        pytest.skip("there is no gcc: LinuxCNC's kinematics are not compared")
    folder = Path(tempfile.mkdtemp())
    (folder / "hal.c").write_text(HAL)
    library = folder / "hal.so"
    command = ["gcc", "-shared", "-fPIC", "-O1", "-o", library, folder / "hal.c"]
    subprocess.run(command, check=True)
    found = ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    shutil.rmtree(folder)
    found.pin_value.restype = ctypes.c_void_p
    found.pin_name.restype = ctypes.c_char_p
    return found


@cache
def kinematics(name):
    """Return a module by its name; skip where it is not installed."""
    file = MODULES / f"{name}.so"
    if not file.exists():
        pytest.skip(f"{file} is not installed: LinuxCNC's kinematics are not compared")
    return Kinematics(file)


class Kinematics:
    """A module: its pins, and X Y Z A B C U V W for joints and back."""

    def __init__(self, file):
        self.hal = _hal()
        self.module = ctypes.CDLL(str(file))
        assert self.module.rtapi_app_main() == 0
        switch = getattr(self.module, "kinematicsSwitch", None)
        if switch:
            switch(0)

    def pins(self):
        """Return the names of the pins of all modules."""
        names = []
        while name := self.hal.pin_name(len(names)):
            names.append(name.decode())
        return names

    def set(self, pin, value):
        """Set a pin: a float, a whole number or a truth."""
        kind = {bool: ctypes.c_bool, int: ctypes.c_int}.get(type(value), ctypes.c_double)
        kind.from_address(self.hal.pin_value(pin.encode())).value = value

    def forward(self, joints):
        """Return world positions (n, 9) for joints (n, m)."""
        return self._through(self.module.kinematicsForward, joints, JOINTS, 9)

    def inverse(self, world):
        """Return joints (n, 9) for world positions (n, 9)."""
        return self._through(self.module.kinematicsInverse, world, 9, JOINTS)[:, :9]

    @staticmethod
    def _through(function, rows, room_in, room_out):
        found = np.empty((len(rows), room_out))
        given, told = (ctypes.c_double * room_in)(), (ctypes.c_double * room_out)()
        flags = (ctypes.c_ulong * 2)(), (ctypes.c_ulong * 2)()
        for k, row in enumerate(rows):
            given[: len(row)] = list(row)
            assert function(given, told, *flags) == 0
            found[k] = told[:]
        return found

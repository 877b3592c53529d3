"""A job in FreeCAD, posted by the posts that are named: run by `freecadcmd`, not by pytest.

A plate of 40 by 30 by 4 mm with a hole: once around it at one depth, then the hole is drilled.
POSTS names the posts, one in a line, each as FILE=POST with its words; FILE is what it writes
into the folder OUT, and FILE.error what goes wrong in it.
"""

import os
import shlex
import traceback

import FreeCAD
import PathScripts.PathDrilling as PathDrilling
import PathScripts.PathJob as PathJob
import PathScripts.PathProfile as PathProfile
from PathScripts.PathPostProcessor import PostProcessor


def plate():
    """Return a document and its part."""
    document = FreeCAD.newDocument("job")
    box = document.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 40, 30, 4
    hole = document.addObject("Part::Cylinder", "Hole")
    hole.Radius, hole.Height = 2.5, 4
    hole.Placement.Base = FreeCAD.Vector(20, 15, 0)
    part = document.addObject("Part::Cut", "Cut")
    part.Base, part.Tool = box, hole
    document.recompute()
    return document, part


def operations():
    """Return what is posted: the tool, the profile and the hole."""
    document, part = plate()
    job = PathJob.Create("Job", [part], None)
    tool = job.Tools.Group[0]
    tool.HorizFeed, tool.VertFeed = "600 mm/min", "200 mm/min"
    tool.HorizRapid = tool.VertRapid = "3000 mm/min"
    tool.SpindleSpeed, tool.SpindleDir = 8000, "Forward"
    if not hasattr(tool.Tool, "ToolType"):  # the post fanuc asks for it
        tool.Tool.addProperty("App::PropertyString", "ToolType")
    profile = PathProfile.Create("Profile")
    profile.StepDown = "20 mm"
    drilling = PathDrilling.Create("Drilling")
    document.recompute()
    model = job.Model.Group[0]
    faces = enumerate(model.Shape.Faces, 1)
    round_ones = [f"Face{n}" for n, face in faces if face.Surface.TypeId == "Part::GeomCylinder"]
    drilling.Base = [(model, round_ones)]
    document.recompute()
    return [tool, profile, drilling]


def main():
    """Post the job by each post."""
    objects = operations()
    for line in os.environ["POSTS"].splitlines():
        name, *words = shlex.split(line)
        file, _, name = name.partition("=")
        place = os.path.join(os.environ["OUT"], file)
        try:
            post = PostProcessor.load(name)
            text = post.export(objects, place, shlex.join(["--no-show-editor", *words]))
            if isinstance(text, str) and text and not os.path.exists(place):
                with open(place, "w") as stream:
                    stream.write(text)
        except BaseException:
            with open(os.path.join(os.environ["OUT"], file + ".error"), "w") as stream:
                stream.write(traceback.format_exc())


main()

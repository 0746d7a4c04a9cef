"""Errors and warnings of the program, and the objects that they name."""
import re

LINE = re.compile(r"^sprung: (error|warning): (.*)$")
KEY = re.compile(r"\b(bodies|obstacles)\.([A-Za-z0-9_-]+)|\battachments\[(\d+)\]")
MESH = re.compile(r"\bmeshes/(?:[^/\s]+/)?([A-Za-z0-9_-]+?)(?:\.\d+)?\.obj")
QUOTED = re.compile(r'"([A-Za-z0-9_-]+)"')


class Message:
    """A line of the program. `objects` are the names of the Blender objects that it names."""

    def __init__(self, level, text, objects=()):
        self.level, self.text, self.objects = level, text, list(objects)

    def __repr__(self):
        return f"{self.level}: {self.text} {self.objects}"


def objects_named(text, links):
    """The Blender objects of the bodies, obstacles, attachments and mesh files that a text names."""
    things = {name: body["object"] for name, body in links.get("bodies", {}).items()}
    things.update(links.get("obstacles", {}))
    owners = links.get("attachments", [])
    found = []
    for _, name, number in KEY.findall(text):
        if number and int(number) < len(owners):
            found.append(owners[int(number)])
        elif name in things:
            found.append(things[name])
    if not found:
        found = [things[name] for name in MESH.findall(text) + QUOTED.findall(text) if name in things]
    return list(dict.fromkeys(found))


def parse(text, links):
    """The messages in what the program wrote to standard error."""
    found = []
    for line in text.splitlines():
        match = LINE.match(line)
        if match:
            found.append(Message(match[1].upper(), match[2], objects_named(match[2], links)))
    return found

"""bare_urdf.py FILE...: takes out of URDFs of `rne export` the links that carry nothing, which cost dynibo time.

These are `world`, where `base` stands, and frames on fixed joints.
"""

import sys
from xml.etree import ElementTree


def main():
    for path in sys.argv[1:]:
        tree = ElementTree.parse(path)
        robot = tree.getroot()
        links = {link.get("name"): link for link in robot.findall("link")}
        for joint in robot.findall("joint[@type='fixed']"):
            parent, child = (joint.find(end).get("link") for end in ("parent", "child"))
            origin = joint.find("origin").attrib if parent == "world" else {}
            if any(float(x) for text in origin.values() for x in text.split()):
                sys.exit(f"{path}: base is not at the origin of the world")
            robot.remove(joint)
            robot.remove(links["world" if parent == "world" else child])
        tree.write(path)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorial's sheet, sheet.toml, from Python: solved, drawn and written for ParaView."""
import subprocess
import anticrack
from anticrack import Accuracy, Case, Geometry, Hole, Inclusion, Load, Region, Side, Units

geometry = Geometry(
    boundary=[Side(name="wall", points=[(0, 200), (0, 0), (200, 0)]), Side(name="right", points=[(200, 0), (200, 100)]),
              Side(name="corner", arc=[(200, 100), (129.28932188, 129.28932188), (100, 200)]),
              Side(name="top", points=[(100, 200), (0, 200)])],
    holes=[Hole(name="window", circle={"center": (45, 150), "radius": 20})], neumann=["right", "top", "window"],
    inclusions=[Inclusion("low", center=(120, 50), angle=20, length=80, delaminated=[(0.5, 1.0)], side="left"),
                Inclusion("steep", center=(40, 80), angle=75, length=60, delaminated=False)],
    regions=[Region("patch", circle={"center": (120, 50), "radius": 25}, tension=2),
             Region("sheet", at=(20, 20), tension=2)])
loads = [Load("up", {"patch": 1e-3}, inclusion_forces={"steep": 0.5}),
         Load("down", {"patch": -1e-3}, inclusion_forces={"steep": 0.5})]
with anticrack.local() as client:
    result = client.run(Case(geometry, loads, accuracy=Accuracy(A=1e-2), units=Units("mm", "N"), fields=True))
print(result)
anticrack.draw.pressure(result, "up").figure.savefig("pressure.png")
result.save("sheet.h5")
subprocess.run(["anticrack", "export", "sheet.h5", "-o", "paraview"], check=True)

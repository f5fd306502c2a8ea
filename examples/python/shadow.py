"""Draws the scene's shadow on the ground and a picture: python3 shadow.py scene.fathom"""
import sys

import fathom
import numpy as np

scene = fathom.load(sys.argv[1])
x, z = np.meshgrid(np.linspace(-3, 3, 60), np.linspace(-3, 3, 30))
origins = np.stack([x, np.zeros_like(x) + 0.01, z], axis=-1)
shadow = scene.march(origins, np.broadcast_to([0.3, 1.0, 0.2], origins.shape)).hit
print("\n".join("".join("#" if s else "." for s in row) for row in shadow))
scene.render(width=320, height=180, samples=16, denoise=True).save("picture.png")

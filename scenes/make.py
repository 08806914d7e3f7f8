#!/usr/bin/env python3
"""Makes the meshes and textures of the scenes in this folder: `python3 scenes/make.py [SCENE...]`.

Needs nothing but Python; the same files on every run. The scene files (.toml) are written by hand unless
`making/` says otherwise.
"""

import importlib
import pathlib
import sys

SCENES = ['shapes', 'cornell', 'glass', 'metals', 'room', 'depth-of-field', 'showcase', 'city', 'lanterns', 'furnace',
          'instances', 'effects']

if __name__ == '__main__':
    sys.dont_write_bytecode = True
    here = pathlib.Path(__file__).resolve().parent
    sys.path.insert(0, str(here))
    for scene in sys.argv[1:] or SCENES:
        folder = here / scene
        folder.mkdir(exist_ok=True)
        importlib.import_module('making.scene_' + scene.replace('-', '_')).make(folder)
        size = sum(file.stat().st_size for file in folder.iterdir())
        print(f'{scene}: {size / 1024:.0f} KiB')

"""Show a robot: a scene of plain values, made of a `Robot`, and the page that draws it.

scene.py      Robot -> Scene: links, joints, shapes and states
files.py      the meshes of a robot, and the textures and materials that they name, by digest
html.py       the page with a scene inside, as one text
picture.py    a picture of that text, by the browser of this machine
session.py    what a live viewer holds: settings, the last good scene, problems and versions
updates.py    what its pages receive: problems and settings as plain values
server.py     the page of a session over HTTP on this machine, with an event for each change
page/         the page itself, in TypeScript, built by `npm run build`
"""

"""The self-collision matrix: which pairs of links need no check, found by sampling the positions of the joints.

Each module imports only those above it:

    scene      bodies, their motion and shapes, and pairs of them, as plain values that other processes can get
    meshes     find and read the meshes of collisions
    collider   compute which pairs collide at some positions, with Pinocchio and coal
    sampling   sample positions, in this process or in several, and give each pair its reason
    matrix     put together what is declared and what is found
    poses      find which pairs collide in the named states of groups
    rewrite    the text of `disabled_collisions`, and a spec with it
"""

"""The self-collision matrix: which pairs of links need no check, found by sampling the positions of the joints.

Each module imports only those above it:

    scene      bodies, their motion and shapes, as plain values that other processes can get
    meshes     find and read the meshes of collisions
    pairs      the pairs of links: which are adjacent, and which can be compared at all
    collider   compute which pairs collide at some positions, with Pinocchio and coal
    blocks     search blocks of samples for collisions, in this process or in several
    sampling   sample positions, and give each pair its reason
    modules    which modules declare pairs of their own, so that they are not sampled inside
    matrix     put together what is declared and what is found
    poses      find which pairs collide in the named states of groups
    section    the text of `disabled_collisions`
"""

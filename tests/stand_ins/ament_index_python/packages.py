import os
from pathlib import Path


def get_package_share_directory(name):
    prefixes = os.environ["AMENT_PREFIX_PATH"].split(os.pathsep)
    return str(next(folder for prefix in prefixes if (folder := Path(prefix, "share", name)).is_dir()))

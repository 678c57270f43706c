"""How long a test waits for what takes a moment on a free machine; under a sanitizer longer (CMakePresets.json)."""
import os

PATIENCE = float(os.environ.get("MILLSCOPE_PATIENCE", 240))  # s

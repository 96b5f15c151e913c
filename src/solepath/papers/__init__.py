"""Published systems: a folder contains the parts, calibration and recipes of one, and is loaded on request.

- footstep_tracker: Liu et al. 2015, "Track your foot step: anchor-free indoor localization based on sensing users' foot
  steps"
- kupt_dfpc: Chen et al. 2019, "Smart insole-based indoor localization system for Internet of Things applications"
- pressure_contour: Bebek et al. 2010, "Personal navigation via high-resolution gait-corrected inertial measurement
  units"
- shoe_sensing: Li et al. 2016, "3D tracking via shoe sensing"
- walking_modes: Gong et al. 2023, "Improving accuracy of real-time positioning and path tracking by using an error
  compensation algorithm against walking modes"
"""

from ..events import StrideFused, TouchedDown, WalkingModeChanged
from ..types import WalkingMode

__all__ = ["StrideFused", "TouchedDown", "WalkingMode", "WalkingModeChanged"]

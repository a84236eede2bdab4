"""The node ``joint_sliders``: a window with a slider for each joint, and the joint states of it.

joint_state_publisher_gui does the same for any robot, but Debian 12's does not start: it gives Qt
fractions where that wants whole numbers.
"""

from __future__ import annotations

import numpy as np
import rospy
from sensor_msgs.msg import JointState

from .. import arm
from ..exceptions import InputError
from ..interface import SliderParameters
from ..state_messages import joint_state_message
from .common import JOINT_STATES_TOPIC, read_parameters, run_node

RESOLUTION = 0.001  # rad
LENGTH = 420  # pixels
STANDING = (0.0,) * arm.DOF  # rad/s


class JointSliders:
    """The window.

    Raises:
        InputError: there is no Tk, or no screen to show it on.
    """

    def __init__(self, parameters: SliderParameters):
        try:
            import tkinter
        except ImportError as error:
            raise InputError("sliders need Tk: apt-get install python3-tk") from error
        try:
            self._window = tkinter.Tk(className="joint sliders")
        except tkinter.TclError as error:
            raise InputError(f"there is no screen for the sliders: {error}") from error
        self._limits = arm.joint_limits(parameters.limits)
        style = {"resolution": RESOLUTION, "orient": "horizontal", "length": LENGTH}
        self._sliders = []
        for i, name in enumerate(arm.JOINT_NAMES):
            ends = {"from_": float(self._limits.lower[i]), "to": float(self._limits.upper[i])}
            slider = tkinter.Scale(self._window, label=f"{name} (rad)", **ends, **style)
            slider.set(parameters.start[i])
            slider.pack(fill="x", padx=8)
            self._sliders.append(slider)
        self._period = max(1, round(1000 / parameters.rate))  # ms
        self._states = rospy.Publisher(JOINT_STATES_TOPIC, JointState, queue_size=10)

    def spin(self) -> None:
        """Publishes where the sliders are until the window is closed or ROS shuts down."""
        self._publish()
        self._window.mainloop()

    def _publish(self) -> None:
        if rospy.is_shutdown():
            self._window.destroy()
            return
        # A slider's ends are rounded to its steps, and may be a little beyond the limits.
        positions = np.clip(
            [slider.get() for slider in self._sliders], self._limits.lower, self._limits.upper
        )
        self._states.publish(joint_state_message(rospy.Time.now(), positions, STANDING))
        self._window.after(self._period, self._publish)


def main() -> None:
    run_node(
        "joint_sliders", lambda: JointSliders(read_parameters(SliderParameters.from_dict)).spin()
    )

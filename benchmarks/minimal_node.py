"""The least that a node of PyKDL and rospy does: what ``startup.py`` compares planner_node with.

It waits for the arm's joint states, puts them through KDL, and publishes a trajectory of one point.
"""

import sys

import PyKDL
import rospy
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from urdf_chain import kdl_chain


def forward(solver, position):
    q, frame = PyKDL.JntArray(5), PyKDL.Frame()
    for i, value in enumerate(position):
        q[i] = value
    solver.JntToCart(q, frame)
    return frame


def main(urdf, topic):
    rospy.init_node("minimal")
    publisher = rospy.Publisher(topic, JointTrajectory, queue_size=1)
    chain = kdl_chain(urdf)
    state = rospy.wait_for_message("joint_states", JointState)
    forward(PyKDL.ChainFkSolverPos_recursive(chain), state.position)
    while not publisher.get_num_connections():
        rospy.sleep(0.01)
    message = JointTrajectory(joint_names=state.name)
    message.points = [JointTrajectoryPoint(positions=state.position)]
    publisher.publish(message)
    rospy.spin()


if __name__ == "__main__":
    main(*rospy.myargv(sys.argv)[1:])

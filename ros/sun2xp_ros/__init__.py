"""The hand of the library sun2xp as a ROS 2 node. `sun2xp_ros.node` has the node."""

"""Limb controllers as ROS 2 topics."""

"""Logs of a bus or a robot: CAN frames and MCAP topics to signals, signals to one table."""

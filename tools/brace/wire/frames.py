"""Frames of the wire by name. Written by tools/interface from messages.toml; do not edit."""

from __future__ import annotations

from brace.wire import codes
from brace.wire.layout import Field, Layout

DICTIONARY_HASH = 0x5E29BE72
PROTOCOL = 2
REQUEST_ID = 0x600
ANSWER_ID = 0x580
REFUSED = 255  # the number of an answer that is a refusal

MESSAGES: dict[str, Layout] = {
    "emergency": Layout("emergency", 0x080, None, (
        Field("error_code", 0, 16),
        Field("error_register", 16, 4),
        Field("drift_cause", 20, 4, codes=codes.DRIFT_CAUSE),
        Field("mode", 24, 8, codes=codes.MODE),
        Field("faults", 32, 32, codes=codes.FAULT),
    )),
    "stiffness_a": Layout("stiffness_a", 0x180, None, (
        Field("sequence", 0, 8),
        Field("k_xx", 8, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        Field("k_xz", 32, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        Field("age", 56, 8, kind="value", step=0.5, unit="ms"),
    )),
    "stiffness_b": Layout("stiffness_b", 0x280, None, (
        Field("sequence", 0, 8),
        Field("k_zz", 8, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        Field("flags", 32, 16, codes=codes.FLAG),
        Field("play_femur", 48, 4, codes=codes.PLAY),
        Field("play_tibia", 52, 4, codes=codes.PLAY),
        Field("mode", 56, 8, codes=codes.MODE),
    )),
    "eigenvalues": Layout("eigenvalues", 0x380, None, (
        Field("sequence", 0, 8),
        Field("lambda_min", 8, 20, kind="value", step=0.0005, unit="N/mm"),
        Field("lambda_max", 28, 20, kind="value", step=0.005, unit="N/mm"),
        Field("stiff_axis", 48, 16, kind="value", signed=True, step=0.0001, unit="rad"),
    )),
    "posture": Layout("posture", 0x480, None, (
        Field("sequence", 0, 8),
        Field("theta1", 8, 20, kind="value", signed=True, step=2e-05, unit="rad"),
        Field("theta2", 28, 20, kind="value", signed=True, step=2e-05, unit="rad"),
        Field("parameter_tag", 48, 16),
    )),
    "heartbeat": Layout("heartbeat", 0x700, None, (
        Field("state", 0, 8, codes=codes.HEARTBEAT_STATE),
        Field("mode", 8, 8, codes=codes.MODE),
        Field("setting", 16, 8, codes=codes.SETTING),
        Field("protocol", 24, 8),
        Field("dictionary_hash", 32, 32),
    )),
}

# Groups of frames that share an identifier.
GROUPS: dict[str, tuple[Layout, ...]] = {
    "condition": (
        Layout("condition", 0x200, None, (
            Field("sequence", 0, 8),
            Field("faults", 16, 32, codes=codes.FAULT),
            Field("mode", 48, 8, codes=codes.MODE),
            Field("setting", 56, 8, codes=codes.SETTING),
        ), part=0, part_at=8),
    ),
    "space": (
        Layout("space_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xy", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        ), part=16, part_at=8),
        Layout("space_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_xz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_yy", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        ), part=17, part_at=8),
        Layout("space_2", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_yz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_zz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        ), part=18, part_at=8),
        Layout("space_3", 0x200, None, (
            Field("sequence", 0, 8),
            Field("lambda_1", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("lambda_2", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        ), part=19, part_at=8),
        Layout("space_4", 0x200, None, (
            Field("sequence", 0, 8),
            Field("lambda_3", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("flags", 40, 16, codes=codes.FLAG),
            Field("age", 56, 8, kind="value", step=0.5, unit="ms"),
        ), part=20, part_at=8),
        Layout("space_5", 0x200, None, (
            Field("sequence", 0, 8),
            Field("stiff_axis_x", 16, 16, kind="value", signed=True, step=5e-05),
            Field("stiff_axis_y", 32, 16, kind="value", signed=True, step=5e-05),
            Field("stiff_axis_z", 48, 16, kind="value", signed=True, step=5e-05),
        ), part=21, part_at=8),
        Layout("space_6", 0x200, None, (
            Field("sequence", 0, 8),
            Field("theta0", 16, 20, kind="value", signed=True, step=2e-05, unit="rad"),
            Field("k_across", 36, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("play_coxa", 60, 4, codes=codes.PLAY),
        ), part=22, part_at=8),
    ),
    "load": (
        Layout("load_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("unloaded_k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("unloaded_k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        ), part=32, part_at=8),
        Layout("load_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("unloaded_k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("flags", 40, 16, codes=codes.FLAG),
        ), part=33, part_at=8),
        Layout("load_2", 0x200, None, (
            Field("sequence", 0, 8),
            Field("counted_force_x", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("counted_force_z", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        ), part=34, part_at=8),
        Layout("load_3", 0x200, None, (
            Field("sequence", 0, 8),
            Field("moved_x", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
            Field("moved_z", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
        ), part=35, part_at=8),
        Layout("load_4", 0x200, None, (
            Field("sequence", 0, 8),
            Field("buckling_factor", 16, 32, kind="f32"),
            Field("gravity_direction", 48, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        ), part=36, part_at=8),
        Layout("load_5", 0x200, None, (
            Field("sequence", 0, 8),
            Field("gravity_lean", 16, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        ), part=37, part_at=8),
    ),
    "load_across": (
        Layout("load_across_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("counted_force_y", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("moved_y", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
        ), part=48, part_at=8),
        Layout("load_across_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("unloaded_k_across", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("flags", 40, 16, codes=codes.FLAG),
        ), part=49, part_at=8),
    ),
    "sigma": (
        Layout("sigma_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_xx", 16, 16, kind="value", step=0.002, unit="N/mm"),
            Field("k_xz", 32, 16, kind="value", step=0.002, unit="N/mm"),
            Field("k_zz", 48, 16, kind="value", step=0.002, unit="N/mm"),
        ), part=64, part_at=8),
        Layout("sigma_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("lambda_min", 16, 16, kind="value", step=0.0005, unit="N/mm"),
            Field("lambda_max", 32, 16, kind="value", step=0.004, unit="N/mm"),
            Field("stiff_axis", 48, 16, kind="value", step=0.0001, unit="rad"),
        ), part=65, part_at=8),
    ),
    "sigma_space": (
        Layout("sigma_space_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_xx", 16, 16, kind="value", step=0.002, unit="N/mm"),
            Field("k_xy", 32, 16, kind="value", step=0.002, unit="N/mm"),
            Field("k_xz", 48, 16, kind="value", step=0.002, unit="N/mm"),
        ), part=80, part_at=8),
        Layout("sigma_space_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_yy", 16, 16, kind="value", step=0.002, unit="N/mm"),
            Field("k_yz", 32, 16, kind="value", step=0.002, unit="N/mm"),
            Field("k_zz", 48, 16, kind="value", step=0.002, unit="N/mm"),
        ), part=81, part_at=8),
        Layout("sigma_space_2", 0x200, None, (
            Field("sequence", 0, 8),
            Field("lambda_1", 16, 16, kind="value", step=0.0005, unit="N/mm"),
            Field("lambda_2", 32, 16, kind="value", step=0.002, unit="N/mm"),
            Field("lambda_3", 48, 16, kind="value", step=0.004, unit="N/mm"),
        ), part=82, part_at=8),
        Layout("sigma_space_3", 0x200, None, (
            Field("sequence", 0, 8),
            Field("k_across", 16, 16, kind="value", step=0.002, unit="N/mm"),
        ), part=83, part_at=8),
    ),
    "interval": (
        Layout("interval_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("force_x_low", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("force_x_high", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        ), part=96, part_at=8),
        Layout("interval_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("force_z_low", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("force_z_high", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        ), part=97, part_at=8),
        Layout("interval_2", 0x200, None, (
            Field("sequence", 0, 8),
            Field("load_femur_low", 16, 24, kind="value", signed=True, step=0.2, unit="N mm"),
            Field("load_femur_high", 40, 24, kind="value", signed=True, step=0.2, unit="N mm"),
        ), part=98, part_at=8),
        Layout("interval_3", 0x200, None, (
            Field("sequence", 0, 8),
            Field("load_tibia_low", 16, 24, kind="value", signed=True, step=0.2, unit="N mm"),
            Field("load_tibia_high", 40, 24, kind="value", signed=True, step=0.2, unit="N mm"),
        ), part=99, part_at=8),
    ),
    "interval_across": (
        Layout("interval_across_0", 0x200, None, (
            Field("sequence", 0, 8),
            Field("force_y_low", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("force_y_high", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        ), part=112, part_at=8),
        Layout("interval_across_1", 0x200, None, (
            Field("sequence", 0, 8),
            Field("load_coxa_low", 16, 24, kind="value", signed=True, step=0.2, unit="N mm"),
            Field("load_coxa_high", 40, 24, kind="value", signed=True, step=0.2, unit="N mm"),
        ), part=113, part_at=8),
    ),
}

FD_GROUPS: dict[str, tuple[Layout, ...]] = {
    "space_fd": (
        Layout("space_fd", 0x300, None, (
            Field("sequence", 0, 8),
            Field("age", 16, 16, kind="value", step=0.5, unit="ms"),
            Field("flags", 32, 16, codes=codes.FLAG),
            Field("parameter_tag", 48, 16),
            Field("mode", 64, 8, codes=codes.MODE),
            Field("play_coxa", 72, 8, codes=codes.PLAY),
            Field("stiff_axis_x", 80, 16, kind="value", signed=True, step=5e-05),
            Field("stiff_axis_y", 96, 16, kind="value", signed=True, step=5e-05),
            Field("stiff_axis_z", 112, 16, kind="value", signed=True, step=5e-05),
            Field("theta0", 128, 32, kind="f32", unit="rad"),
            Field("k_across", 160, 32, kind="f32", unit="N/mm"),
            Field("k_xx", 192, 32, kind="f32", unit="N/mm"),
            Field("k_xy", 224, 32, kind="f32", unit="N/mm"),
            Field("k_xz", 256, 32, kind="f32", unit="N/mm"),
            Field("k_yy", 288, 32, kind="f32", unit="N/mm"),
            Field("k_yz", 320, 32, kind="f32", unit="N/mm"),
            Field("k_zz", 352, 32, kind="f32", unit="N/mm"),
            Field("lambda_1", 384, 32, kind="f32", unit="N/mm"),
            Field("lambda_2", 416, 32, kind="f32", unit="N/mm"),
            Field("lambda_3", 448, 32, kind="f32", unit="N/mm"),
        ), 64, part=16, part_at=8),
    ),
    "load_fd": (
        Layout("load_fd", 0x300, None, (
            Field("sequence", 0, 8),
            Field("age", 16, 16, kind="value", step=0.5, unit="ms"),
            Field("flags", 32, 16, codes=codes.FLAG),
            Field("parameter_tag", 48, 16),
            Field("unloaded_k_xx", 64, 32, kind="f32", unit="N/mm"),
            Field("unloaded_k_xz", 96, 32, kind="f32", unit="N/mm"),
            Field("unloaded_k_zz", 128, 32, kind="f32", unit="N/mm"),
            Field("counted_force_x", 160, 32, kind="f32", unit="N"),
            Field("counted_force_z", 192, 32, kind="f32", unit="N"),
            Field("moved_x", 224, 32, kind="f32", unit="mm"),
            Field("moved_z", 256, 32, kind="f32", unit="mm"),
            Field("buckling_factor", 288, 32, kind="f32"),
            Field("gravity_direction", 320, 32, kind="f32", unit="rad"),
            Field("gravity_lean", 352, 32, kind="f32", unit="rad"),
            Field("counted_force_y", 384, 32, kind="f32", unit="N"),
            Field("moved_y", 416, 32, kind="f32", unit="mm"),
            Field("unloaded_k_across", 448, 32, kind="f32", unit="N/mm"),
        ), 64, part=32, part_at=8),
    ),
    "sigma_fd": (
        Layout("sigma_fd", 0x300, None, (
            Field("sequence", 0, 8),
            Field("stiff_axis", 16, 16, kind="value", step=0.0001, unit="rad"),
            Field("k_xx", 32, 32, kind="f32", unit="N/mm"),
            Field("k_xz", 64, 32, kind="f32", unit="N/mm"),
            Field("k_zz", 96, 32, kind="f32", unit="N/mm"),
            Field("lambda_min", 128, 32, kind="f32", unit="N/mm"),
            Field("lambda_max", 160, 32, kind="f32", unit="N/mm"),
            Field("space_k_xx", 192, 32, kind="f32", unit="N/mm"),
            Field("space_k_xy", 224, 32, kind="f32", unit="N/mm"),
            Field("space_k_xz", 256, 32, kind="f32", unit="N/mm"),
            Field("space_k_yy", 288, 32, kind="f32", unit="N/mm"),
            Field("space_k_yz", 320, 32, kind="f32", unit="N/mm"),
            Field("space_k_zz", 352, 32, kind="f32", unit="N/mm"),
            Field("space_lambda_1", 384, 32, kind="f32", unit="N/mm"),
            Field("space_lambda_2", 416, 32, kind="f32", unit="N/mm"),
            Field("space_lambda_3", 448, 32, kind="f32", unit="N/mm"),
            Field("k_across", 480, 32, kind="f32", unit="N/mm"),
        ), 64, part=64, part_at=8),
    ),
    "interval_fd": (
        Layout("interval_fd", 0x300, None, (
            Field("sequence", 0, 8),
            Field("parameter_tag", 16, 16),
            Field("force_x_low", 32, 32, kind="f32", unit="N"),
            Field("force_x_high", 64, 32, kind="f32", unit="N"),
            Field("force_z_low", 96, 32, kind="f32", unit="N"),
            Field("force_z_high", 128, 32, kind="f32", unit="N"),
            Field("load_femur_low", 160, 32, kind="f32", unit="N mm"),
            Field("load_femur_high", 192, 32, kind="f32", unit="N mm"),
            Field("load_tibia_low", 224, 32, kind="f32", unit="N mm"),
            Field("load_tibia_high", 256, 32, kind="f32", unit="N mm"),
            Field("force_y_low", 288, 32, kind="f32", unit="N"),
            Field("force_y_high", 320, 32, kind="f32", unit="N"),
            Field("load_coxa_low", 352, 32, kind="f32", unit="N mm"),
            Field("load_coxa_high", 384, 32, kind="f32", unit="N mm"),
        ), 64, part=96, part_at=8),
    ),
}

FD_MESSAGES: dict[str, Layout] = {
    "snapshot_fd": Layout("snapshot_fd", 0x500, None, (
        Field("sequence", 0, 32),
        Field("parameter_tag", 32, 16),
        Field("age", 48, 16, kind="value", step=0.5, unit="ms"),
        Field("flags", 64, 16, codes=codes.FLAG),
        Field("mode", 80, 8, codes=codes.MODE),
        Field("play_femur", 88, 4, codes=codes.PLAY),
        Field("play_tibia", 92, 4, codes=codes.PLAY),
        Field("faults", 96, 32, codes=codes.FAULT),
        Field("k_xx", 128, 32, kind="f32", unit="N/mm"),
        Field("k_xz", 160, 32, kind="f32", unit="N/mm"),
        Field("k_zz", 192, 32, kind="f32", unit="N/mm"),
        Field("lambda_min", 224, 32, kind="f32", unit="N/mm"),
        Field("lambda_max", 256, 32, kind="f32", unit="N/mm"),
        Field("stiff_axis", 288, 32, kind="f32", unit="rad"),
        Field("theta1", 320, 32, kind="f32", unit="rad"),
        Field("theta2", 352, 32, kind="f32", unit="rad"),
        Field("tip_x", 384, 32, kind="f32", unit="mm"),
        Field("tip_z", 416, 32, kind="f32", unit="mm"),
        Field("force_x", 448, 32, kind="f32", unit="N"),
        Field("force_z", 480, 32, kind="f32", unit="N"),
    ), 64),
}

REQUESTS: dict[str, Layout] = {
    "read_entry": Layout("read_entry_request", 0x600, 1, (
        Field("index", 16, 16),
    )),
    "write_entry": Layout("write_entry_request", 0x600, 2, (
        Field("index", 16, 16),
        Field("value", 32, 32),
    )),
    "k_at_posture": Layout("k_at_posture_request", 0x600, 3, (
        Field("theta1", 16, 24, kind="value", signed=True, step=1e-06, unit="rad"),
        Field("theta2", 40, 24, kind="value", signed=True, step=1e-06, unit="rad"),
    )),
    "k_at_tip_knee_up": Layout("k_at_tip_knee_up_request", 0x600, 4, (
        Field("x", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
        Field("z", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
    )),
    "k_at_tip_knee_down": Layout("k_at_tip_knee_down_request", 0x600, 5, (
        Field("x", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
        Field("z", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
    )),
    "contact_force": Layout("contact_force_request", 0x600, 6, (
        Field("dx", 16, 24, kind="value", signed=True, step=0.0001, unit="mm"),
        Field("dz", 40, 24, kind="value", signed=True, step=0.0001, unit="mm"),
    )),
    "sag_for_load": Layout("sag_for_load_request", 0x600, 7, (
        Field("fx", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
        Field("fz", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
    )),
    "friction_margin": Layout("friction_margin_request", 0x600, 8, (
        Field("normal", 16, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        Field("friction", 32, 16, kind="value", step=0.001, unit="1"),
    )),
    "set_mode": Layout("set_mode_request", 0x600, 9, (
        Field("mode", 16, 8, codes=codes.MODE),
        Field("key", 24, 16),
    )),
    "upload_begin": Layout("upload_begin_request", 0x600, 10, (
        Field("bytes", 16, 16),
        Field("crc", 32, 32),
    )),
    "upload_word": Layout("upload_word_request", 0x600, 11, (
        Field("word", 16, 16),
        Field("data", 32, 32),
    )),
    "commit": Layout("commit_request", 0x600, 12, (
        Field("crc", 16, 32),
    )),
    "rollback": Layout("rollback_request", 0x600, 13, (
    )),
    "download_word": Layout("download_word_request", 0x600, 14, (
        Field("word", 16, 16),
    )),
    "take_up": Layout("take_up_request", 0x600, 15, (
        Field("joint", 16, 8),
        Field("flank", 24, 8, signed=True),
    )),
    "let_go": Layout("let_go_request", 0x600, 16, (
    )),
    "loading_test_start": Layout("loading_test_start_request", 0x600, 17, (
        Field("axis", 16, 8),
        Field("steps_per_side", 24, 8),
        Field("step", 32, 16, kind="value", step=0.001, unit="mm"),
        Field("dwell_ms", 48, 16),
    )),
    "loading_test_stop": Layout("loading_test_stop_request", 0x600, 18, (
    )),
    "fetch_row": Layout("fetch_row_request", 0x600, 19, (
        Field("row", 16, 16),
        Field("column", 32, 8),
    )),
    "identify": Layout("identify_request", 0x600, 20, (
    )),
    "loading_test_result": Layout("loading_test_result_request", 0x600, 21, (
        Field("item", 16, 8),
    )),
    "clear": Layout("clear_request", 0x600, 22, (
        Field("faults", 16, 32),
    )),
    "k_in_space_at_posture": Layout("k_in_space_at_posture_request", 0x600, 23, (
        Field("theta0", 16, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        Field("theta1", 32, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        Field("theta2", 48, 16, kind="value", signed=True, step=0.0001, unit="rad"),
    )),
    "drift": Layout("drift_request", 0x600, 24, (
    )),
    "take_up_result": Layout("take_up_result_request", 0x600, 25, (
        Field("joint", 16, 8),
    )),
    "set_gravity": Layout("set_gravity_request", 0x600, 26, (
        Field("direction", 16, 24, kind="value", signed=True, step=1e-06, unit="rad"),
        Field("lean", 40, 24, kind="value", signed=True, step=1e-06, unit="rad"),
    )),
    "tip_force": Layout("tip_force_request", 0x600, 27, (
        Field("fx", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
        Field("fz", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
    )),
    "k_under_load_at_posture": Layout("k_under_load_at_posture_request", 0x600, 28, (
        Field("theta1", 16, 24, kind="value", signed=True, step=1e-06, unit="rad"),
        Field("theta2", 40, 24, kind="value", signed=True, step=1e-06, unit="rad"),
    )),
    "k_under_load_at_tip_knee_up": Layout("k_under_load_at_tip_knee_up_request", 0x600, 29, (
        Field("x", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
        Field("z", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
    )),
    "k_under_load_at_tip_knee_down": Layout("k_under_load_at_tip_knee_down_request", 0x600, 30, (
        Field("x", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
        Field("z", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
    )),
    "tip_force_in_space": Layout("tip_force_in_space_request", 0x600, 31, (
        Field("fx", 16, 16, kind="value", signed=True, step=0.01, unit="N"),
        Field("fy", 32, 16, kind="value", signed=True, step=0.01, unit="N"),
        Field("fz", 48, 16, kind="value", signed=True, step=0.01, unit="N"),
    )),
    "sign_of_life": Layout("sign_of_life_request", 0x600, 32, (
        Field("heard", 16, 16),
        Field("check", 32, 32),
    )),
}

ANSWERS: dict[str, tuple[Layout, ...]] = {
    "read_entry": (
        Layout("read_entry_answer_0", 0x580, 1, (
            Field("index", 16, 16),
            Field("value", 32, 32),
        )),
    ),
    "write_entry": (
        Layout("write_entry_answer_0", 0x580, 2, (
            Field("index", 16, 16),
            Field("value", 32, 32),
        )),
    ),
    "k_at_posture": (
        Layout("k_at_posture_answer_0", 0x580, 3, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_posture_answer_1", 0x580, 4, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_posture_answer_2", 0x580, 5, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        )),
        Layout("k_at_posture_answer_3", 0x580, 6, (
            Field("flags", 16, 16, codes=codes.FLAG),
        )),
    ),
    "k_at_tip_knee_up": (
        Layout("k_at_tip_knee_up_answer_0", 0x580, 7, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_up_answer_1", 0x580, 8, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_up_answer_2", 0x580, 9, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        )),
        Layout("k_at_tip_knee_up_answer_3", 0x580, 10, (
            Field("flags", 16, 16, codes=codes.FLAG),
        )),
    ),
    "k_at_tip_knee_down": (
        Layout("k_at_tip_knee_down_answer_0", 0x580, 11, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_down_answer_1", 0x580, 12, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_down_answer_2", 0x580, 13, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        )),
        Layout("k_at_tip_knee_down_answer_3", 0x580, 14, (
            Field("flags", 16, 16, codes=codes.FLAG),
        )),
    ),
    "contact_force": (
        Layout("contact_force_answer_0", 0x580, 15, (
            Field("fx", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("fz", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        )),
        Layout("contact_force_answer_1", 0x580, 16, (
            Field("low", 16, 24, kind="value", step=0.001, unit="N"),
            Field("high", 40, 24, kind="value", step=0.001, unit="N"),
        )),
    ),
    "sag_for_load": (
        Layout("sag_for_load_answer_0", 0x580, 17, (
            Field("dx", 16, 24, kind="value", signed=True, step=0.0001, unit="mm"),
            Field("dz", 40, 24, kind="value", signed=True, step=0.0001, unit="mm"),
        )),
    ),
    "friction_margin": (
        Layout("friction_margin_answer_0", 0x580, 18, (
            Field("margin", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("angle_left", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
            Field("contact", 56, 8, codes=codes.CONTACT),
        )),
    ),
    "set_mode": (
        Layout("set_mode_answer_0", 0x580, 19, (
            Field("mode", 16, 8),
            Field("setting", 24, 8, codes=codes.SETTING),
        )),
    ),
    "upload_begin": (
        Layout("upload_begin_answer_0", 0x580, 20, (
            Field("words", 16, 16),
            Field("setting", 32, 8, codes=codes.SETTING),
        )),
    ),
    "upload_word": (
        Layout("upload_word_answer_0", 0x580, 21, (
            Field("word", 16, 16),
            Field("data", 32, 32),
        )),
    ),
    "commit": (
        Layout("commit_answer_0", 0x580, 22, (
            Field("sequence", 16, 32),
        )),
        Layout("commit_answer_1", 0x580, 23, (
            Field("crc", 16, 32),
            Field("setting", 48, 8, codes=codes.SETTING),
        )),
    ),
    "rollback": (
        Layout("rollback_answer_0", 0x580, 24, (
            Field("sequence", 16, 32),
        )),
        Layout("rollback_answer_1", 0x580, 25, (
            Field("crc", 16, 32),
            Field("setting", 48, 8, codes=codes.SETTING),
        )),
    ),
    "download_word": (
        Layout("download_word_answer_0", 0x580, 26, (
            Field("word", 16, 16),
            Field("data", 32, 32),
        )),
    ),
    "take_up": (
        Layout("take_up_answer_0", 0x580, 27, (
            Field("phase", 16, 8, codes=codes.TAKE_UP_PHASE),
            Field("setting", 24, 8, codes=codes.SETTING),
            Field("begin", 32, 32),
        )),
    ),
    "let_go": (
        Layout("let_go_answer_0", 0x580, 28, (
            Field("mode", 16, 8),
            Field("setting", 24, 8, codes=codes.SETTING),
            Field("begin", 32, 32),
        )),
    ),
    "loading_test_start": (
        Layout("loading_test_start_answer_0", 0x580, 29, (
            Field("rows", 16, 8),
            Field("setting", 24, 8, codes=codes.SETTING),
            Field("begin", 32, 32),
        )),
    ),
    "loading_test_stop": (
        Layout("loading_test_stop_answer_0", 0x580, 30, (
            Field("rows", 16, 16),
            Field("setting", 32, 8, codes=codes.SETTING),
        )),
    ),
    "fetch_row": (
        Layout("fetch_row_answer_0", 0x580, 31, (
            Field("row", 16, 10),
            Field("column", 26, 6),
            Field("value", 32, 32, kind="f32"),
        )),
    ),
    "identify": (
        Layout("identify_answer_0", 0x580, 32, (
            Field("major", 16, 8),
            Field("minor", 24, 8),
            Field("patch", 32, 8),
            Field("protocol", 40, 8),
            Field("node", 48, 8),
        )),
        Layout("identify_answer_1", 0x580, 33, (
            Field("dictionary_hash", 16, 32),
        )),
        Layout("identify_answer_2", 0x580, 34, (
            Field("schema_hash", 16, 32),
        )),
        Layout("identify_answer_3", 0x580, 35, (
            Field("parameter_crc", 16, 32),
            Field("origin", 48, 8, codes=codes.PARAMETER_ORIGIN),
        )),
        Layout("identify_answer_4", 0x580, 36, (
            Field("faults", 16, 32, codes=codes.FAULT),
            Field("mode", 48, 8, codes=codes.MODE),
            Field("setting", 56, 8, codes=codes.SETTING),
        )),
    ),
    "loading_test_result": (
        Layout("loading_test_result_answer_0", 0x580, 37, (
            Field("item", 16, 8),
            Field("outcome", 24, 8, signed=True, codes=codes.LOADING_OUTCOME),
            Field("value", 32, 32, kind="f32"),
        )),
    ),
    "clear": (
        Layout("clear_answer_0", 0x580, 38, (
            Field("faults", 16, 32),
            Field("setting", 48, 8, codes=codes.SETTING),
        )),
    ),
    "k_in_space_at_posture": (
        Layout("k_in_space_at_posture_answer_0", 0x580, 39, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xy", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_in_space_at_posture_answer_1", 0x580, 40, (
            Field("k_xz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_yy", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_in_space_at_posture_answer_2", 0x580, 41, (
            Field("k_yz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_zz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_in_space_at_posture_answer_3", 0x580, 42, (
            Field("lambda_1", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("lambda_2", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_in_space_at_posture_answer_4", 0x580, 43, (
            Field("lambda_3", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("flags", 40, 16, codes=codes.FLAG),
            Field("force_is_told", 56, 8),
        )),
        Layout("k_in_space_at_posture_answer_5", 0x580, 44, (
            Field("dx", 16, 16, kind="value", signed=True, step=0.01, unit="mm"),
            Field("dy", 32, 16, kind="value", signed=True, step=0.01, unit="mm"),
            Field("dz", 48, 16, kind="value", signed=True, step=0.01, unit="mm"),
        )),
    ),
    "drift": (
        Layout("drift_answer_0", 0x580, 45, (
            Field("state", 16, 4, codes=codes.DRIFT_STATE),
            Field("cause", 20, 4, codes=codes.DRIFT_CAUSE),
            Field("could_be", 24, 8, codes=codes.DRIFT_COULD_BE),
            Field("next_step", 32, 8, codes=codes.DRIFT_NEXT_STEP),
            Field("evidence", 40, 24, kind="value", step=0.001),
        )),
        Layout("drift_answer_1", 0x580, 46, (
            Field("loss", 16, 24, kind="value", signed=True, step=1e-05, unit="1"),
            Field("loss_sigma", 40, 24, kind="value", step=1e-05, unit="1"),
        )),
        Layout("drift_answer_2", 0x580, 47, (
            Field("since_readings", 16, 16),
            Field("readings", 32, 32),
        )),
    ),
    "take_up_result": (
        Layout("take_up_result_answer_0", 0x580, 48, (
            Field("joint", 16, 8),
            Field("outcome", 24, 8, signed=True, codes=codes.TAKE_UP_OUTCOME),
            Field("phase", 32, 8, codes=codes.TAKE_UP_PHASE),
            Field("torque", 40, 24, kind="value", signed=True, step=0.1, unit="N mm"),
        )),
    ),
    "set_gravity": (
        Layout("set_gravity_answer_0", 0x580, 49, (
            Field("direction", 16, 24, kind="value", signed=True, step=1e-06, unit="rad"),
            Field("lean", 40, 24, kind="value", signed=True, step=1e-06, unit="rad"),
        )),
    ),
    "tip_force": (
        Layout("tip_force_answer_0", 0x580, 50, (
            Field("fx", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("fz", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        )),
    ),
    "k_under_load_at_posture": (
        Layout("k_under_load_at_posture_answer_0", 0x580, 51, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_under_load_at_posture_answer_1", 0x580, 52, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_under_load_at_posture_answer_2", 0x580, 53, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        )),
        Layout("k_under_load_at_posture_answer_3", 0x580, 54, (
            Field("dx", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
            Field("dz", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
        )),
        Layout("k_under_load_at_posture_answer_4", 0x580, 55, (
            Field("buckling_factor", 16, 32, kind="f32"),
            Field("flags", 48, 16, codes=codes.FLAG),
        )),
    ),
    "k_under_load_at_tip_knee_up": (
        Layout("k_under_load_at_tip_knee_up_answer_0", 0x580, 56, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_under_load_at_tip_knee_up_answer_1", 0x580, 57, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_under_load_at_tip_knee_up_answer_2", 0x580, 58, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        )),
        Layout("k_under_load_at_tip_knee_up_answer_3", 0x580, 59, (
            Field("dx", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
            Field("dz", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
        )),
        Layout("k_under_load_at_tip_knee_up_answer_4", 0x580, 60, (
            Field("buckling_factor", 16, 32, kind="f32"),
            Field("flags", 48, 16, codes=codes.FLAG),
        )),
    ),
    "k_under_load_at_tip_knee_down": (
        Layout("k_under_load_at_tip_knee_down_answer_0", 0x580, 61, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_under_load_at_tip_knee_down_answer_1", 0x580, 62, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_under_load_at_tip_knee_down_answer_2", 0x580, 63, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
        )),
        Layout("k_under_load_at_tip_knee_down_answer_3", 0x580, 64, (
            Field("dx", 16, 24, kind="value", signed=True, step=0.001, unit="mm"),
            Field("dz", 40, 24, kind="value", signed=True, step=0.001, unit="mm"),
        )),
        Layout("k_under_load_at_tip_knee_down_answer_4", 0x580, 65, (
            Field("buckling_factor", 16, 32, kind="f32"),
            Field("flags", 48, 16, codes=codes.FLAG),
        )),
    ),
    "tip_force_in_space": (
        Layout("tip_force_in_space_answer_0", 0x580, 66, (
            Field("fx", 16, 16, kind="value", signed=True, step=0.01, unit="N"),
            Field("fy", 32, 16, kind="value", signed=True, step=0.01, unit="N"),
            Field("fz", 48, 16, kind="value", signed=True, step=0.01, unit="N"),
        )),
    ),
    "sign_of_life": (
        Layout("sign_of_life_answer_0", 0x580, 67, (
            Field("owner", 16, 8, codes=codes.OWNER),
            Field("setting", 24, 8, codes=codes.SETTING),
            Field("number", 32, 32),
        )),
    ),
}

REFUSAL = (
    Layout("refusal", 0x580, 255, (
        Field("code", 16, 8),
        Field("status", 24, 8, signed=True),
        Field("detail", 32, 32),
    )),
)[0]

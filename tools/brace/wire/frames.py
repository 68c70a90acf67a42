"""Frames of the wire by name. Written by tools/interface from messages.toml; do not edit."""

from __future__ import annotations

from brace.wire.layout import Field, Layout

DICTIONARY_HASH = 0x588D26D8
PROTOCOL = 1
REQUEST_ID = 0x600
ANSWER_ID = 0x580
REFUSED_PART = 7

MESSAGES: dict[str, Layout] = {
    "emergency": Layout("emergency", 0x080, None, (
        Field("error_code", 0, 16),
        Field("error_register", 16, 8),
        Field("mode", 24, 8, names={0: "START", 1: "MONITOR", 2: "CONFIGURATION", 3: "TAKING_UP", 4: "LOADING_TEST", 5: "FAULT"}),
        Field("faults", 32, 32, bit_names=("SENSOR_FEMUR", "SENSOR_TIBIA", "ENCODER_STUCK", "TICK_LATE", "PARAMETERS", "STORE", "CAN_BUS_OFF", "MODEL_DRIFT", "CRASHED",)),
    )),
    "stiffness_a": Layout("stiffness_a", 0x180, None, (
        Field("sequence", 0, 8),
        Field("flags", 8, 8, bit_names=("UNCALIBRATED", "NEAR_SINGULAR", "SATURATED", "GAP_OPEN", "STALE", "OUT_OF_RANGE",)),
        Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
    )),
    "stiffness_b": Layout("stiffness_b", 0x280, None, (
        Field("sequence", 0, 8),
        Field("k_zz", 8, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        Field("age", 32, 8, kind="value", step=0.5, unit="ms"),
        Field("play_femur", 40, 4, names={0: "UNKNOWN", 1: "TAKING_UP", 2: "ENGAGED_POSITIVE", 3: "ENGAGED_NEGATIVE", 4: "CROSSING", 5: "FAULT"}),
        Field("play_tibia", 44, 4, names={0: "UNKNOWN", 1: "TAKING_UP", 2: "ENGAGED_POSITIVE", 3: "ENGAGED_NEGATIVE", 4: "CROSSING", 5: "FAULT"}),
        Field("parameter_tag", 48, 16),
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
        Field("mode", 48, 4, names={0: "START", 1: "MONITOR", 2: "CONFIGURATION", 3: "TAKING_UP", 4: "LOADING_TEST", 5: "FAULT"}),
        Field("faults", 52, 12, bit_names=("SENSOR_FEMUR", "SENSOR_TIBIA", "ENCODER_STUCK", "TICK_LATE", "PARAMETERS", "STORE", "CAN_BUS_OFF", "MODEL_DRIFT", "CRASHED",)),
    )),
    "heartbeat": Layout("heartbeat", 0x700, None, (
        Field("state", 0, 8, names={0: "BOOT", 4: "STOPPED", 5: "OPERATIONAL", 127: "PRE_OPERATIONAL"}),
        Field("mode", 8, 8, names={0: "START", 1: "MONITOR", 2: "CONFIGURATION", 3: "TAKING_UP", 4: "LOADING_TEST", 5: "FAULT"}),
        Field("faults", 16, 16, bit_names=("SENSOR_FEMUR", "SENSOR_TIBIA", "ENCODER_STUCK", "TICK_LATE", "PARAMETERS", "STORE", "CAN_BUS_OFF", "MODEL_DRIFT", "CRASHED",)),
        Field("dictionary_hash", 32, 32),
    )),
}

FD_MESSAGES: dict[str, Layout] = {
    "snapshot_fd": Layout("snapshot_fd", 0x500, None, (
        Field("sequence", 0, 32),
        Field("parameter_crc", 32, 32),
        Field("age", 64, 16, kind="value", step=0.5, unit="ms"),
        Field("flags", 80, 16, bit_names=("UNCALIBRATED", "NEAR_SINGULAR", "SATURATED", "GAP_OPEN", "STALE", "OUT_OF_RANGE",)),
        Field("mode", 96, 8, names={0: "START", 1: "MONITOR", 2: "CONFIGURATION", 3: "TAKING_UP", 4: "LOADING_TEST", 5: "FAULT"}),
        Field("play_femur", 104, 4, names={0: "UNKNOWN", 1: "TAKING_UP", 2: "ENGAGED_POSITIVE", 3: "ENGAGED_NEGATIVE", 4: "CROSSING", 5: "FAULT"}),
        Field("play_tibia", 108, 4, names={0: "UNKNOWN", 1: "TAKING_UP", 2: "ENGAGED_POSITIVE", 3: "ENGAGED_NEGATIVE", 4: "CROSSING", 5: "FAULT"}),
        Field("faults", 112, 16, bit_names=("SENSOR_FEMUR", "SENSOR_TIBIA", "ENCODER_STUCK", "TICK_LATE", "PARAMETERS", "STORE", "CAN_BUS_OFF", "MODEL_DRIFT", "CRASHED",)),
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
        Field("mode", 16, 8, names={0: "START", 1: "MONITOR", 2: "CONFIGURATION"}),
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
        Layout("k_at_posture_answer_1", 0x580, 35, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_posture_answer_2", 0x580, 67, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
            Field("flags", 56, 8),
        )),
    ),
    "k_at_tip_knee_up": (
        Layout("k_at_tip_knee_up_answer_0", 0x580, 4, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_up_answer_1", 0x580, 36, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_up_answer_2", 0x580, 68, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
            Field("flags", 56, 8),
        )),
    ),
    "k_at_tip_knee_down": (
        Layout("k_at_tip_knee_down_answer_0", 0x580, 5, (
            Field("k_xx", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("k_xz", 40, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_down_answer_1", 0x580, 37, (
            Field("k_zz", 16, 24, kind="value", signed=True, step=0.0005, unit="N/mm"),
            Field("lambda_min", 40, 24, kind="value", step=0.0005, unit="N/mm"),
        )),
        Layout("k_at_tip_knee_down_answer_2", 0x580, 69, (
            Field("lambda_max", 16, 24, kind="value", step=0.0005, unit="N/mm"),
            Field("stiff_axis", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
            Field("flags", 56, 8),
        )),
    ),
    "contact_force": (
        Layout("contact_force_answer_0", 0x580, 6, (
            Field("fx", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("fz", 40, 24, kind="value", signed=True, step=0.001, unit="N"),
        )),
        Layout("contact_force_answer_1", 0x580, 38, (
            Field("low", 16, 24, kind="value", step=0.001, unit="N"),
            Field("high", 40, 24, kind="value", step=0.001, unit="N"),
        )),
    ),
    "sag_for_load": (
        Layout("sag_for_load_answer_0", 0x580, 7, (
            Field("dx", 16, 24, kind="value", signed=True, step=0.0001, unit="mm"),
            Field("dz", 40, 24, kind="value", signed=True, step=0.0001, unit="mm"),
        )),
    ),
    "friction_margin": (
        Layout("friction_margin_answer_0", 0x580, 8, (
            Field("margin", 16, 24, kind="value", signed=True, step=0.001, unit="N"),
            Field("angle_left", 40, 16, kind="value", signed=True, step=0.0001, unit="rad"),
            Field("contact", 56, 8, names={0: "HOLDS", 1: "SLIDES", 2: "LIFTS"}),
        )),
    ),
    "set_mode": (
        Layout("set_mode_answer_0", 0x580, 9, (
            Field("mode", 16, 8),
        )),
    ),
    "upload_begin": (
        Layout("upload_begin_answer_0", 0x580, 10, (
            Field("words", 16, 16),
        )),
    ),
    "upload_word": (
        Layout("upload_word_answer_0", 0x580, 11, (
            Field("word", 16, 16),
            Field("data", 32, 32),
        )),
    ),
    "commit": (
        Layout("commit_answer_0", 0x580, 12, (
            Field("sequence", 16, 32),
        )),
        Layout("commit_answer_1", 0x580, 44, (
            Field("crc", 16, 32),
        )),
    ),
    "rollback": (
        Layout("rollback_answer_0", 0x580, 13, (
            Field("sequence", 16, 32),
        )),
        Layout("rollback_answer_1", 0x580, 45, (
            Field("crc", 16, 32),
        )),
    ),
    "download_word": (
        Layout("download_word_answer_0", 0x580, 14, (
            Field("word", 16, 16),
            Field("data", 32, 32),
        )),
    ),
    "take_up": (
        Layout("take_up_answer_0", 0x580, 15, (
            Field("phase", 16, 8, names={0: "IDLE", 1: "APPROACH", 2: "VERIFY", 3: "HOLD", 4: "LET_GO"}),
        )),
    ),
    "let_go": (
        Layout("let_go_answer_0", 0x580, 16, (
            Field("mode", 16, 8),
        )),
    ),
    "loading_test_start": (
        Layout("loading_test_start_answer_0", 0x580, 17, (
            Field("rows", 16, 16),
        )),
    ),
    "loading_test_stop": (
        Layout("loading_test_stop_answer_0", 0x580, 18, (
            Field("rows", 16, 16),
        )),
    ),
    "fetch_row": (
        Layout("fetch_row_answer_0", 0x580, 19, (
            Field("row", 16, 10),
            Field("column", 26, 6),
            Field("value", 32, 32, kind="f32"),
        )),
    ),
    "identify": (
        Layout("identify_answer_0", 0x580, 20, (
            Field("major", 16, 8),
            Field("minor", 24, 8),
            Field("patch", 32, 8),
            Field("protocol", 40, 8),
            Field("node", 48, 8),
        )),
        Layout("identify_answer_1", 0x580, 52, (
            Field("dictionary_hash", 16, 32),
        )),
        Layout("identify_answer_2", 0x580, 84, (
            Field("schema_hash", 16, 32),
        )),
        Layout("identify_answer_3", 0x580, 116, (
            Field("parameter_crc", 16, 32),
            Field("origin", 48, 8, names={0: "DEFAULT", 1: "SLOT_A", 2: "SLOT_B"}),
        )),
    ),
    "loading_test_result": (
        Layout("loading_test_result_answer_0", 0x580, 21, (
            Field("item", 16, 8),
            Field("outcome", 24, 8, signed=True),
            Field("value", 32, 32, kind="f32"),
        )),
    ),
    "clear": (
        Layout("clear_answer_0", 0x580, 22, (
            Field("faults", 16, 32),
        )),
    ),
}

REFUSAL = (
    Layout("refusal", 0x580, 224, (
        Field("status", 16, 8, signed=True),
        Field("detail", 24, 32),
    )),
)[0]

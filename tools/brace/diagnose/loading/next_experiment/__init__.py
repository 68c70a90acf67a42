"""What looks alike in a record, and the test that would tell it apart."""

"""Is it the record that is wrong, before any physics is blamed?"""

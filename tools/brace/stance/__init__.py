"""A body on several limbs: what each foot bears, how the body moves, which foot lets go first. The statics are those of
tools/stance; here are the file, the limbs' law, what is not known, and the answers."""

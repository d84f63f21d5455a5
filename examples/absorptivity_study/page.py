def write(found, docs):
    pass
